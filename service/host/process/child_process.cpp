// SPDX-License-Identifier: Apache-2.0
#include "service/host/process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "service/host/process/processors.hpp"

namespace meridian::process {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void become(const std::vector<std::string>& arguments,
                         const ChildProcess::Options& options, int in, int out) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (options.has_own_group) setpgid(0, 0);
  sched_setaffinity(0, sizeof(cpu_set_t), &initial_cpus());
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  if (!options.error_file.empty()) {
    const int error = open(options.error_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(error, STDERR_FILENO);
  }
  if (!options.output_file.empty()) {
    const int output = open(options.output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(output, STDOUT_FILENO);
  }
  for (const std::string& pair : options.environment) {
    const auto equals = pair.find('=');
    setenv(pair.substr(0, equals).c_str(), pair.substr(equals + 1).c_str(), 1);
  }
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  execv(pointers.front(), pointers.data());
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const Options& options) {
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  id_ = fork();
  if (id_ < 0) {
    throw std::runtime_error("cannot fork");
  }
  if (id_ == 0) {
    become(arguments, options, in[0], out[1]);
  }
  close(in[0]);
  close(out[1]);
  to_ = in[1];
  from_ = out[0];
}

ChildProcess::~ChildProcess() {
  close_input();
  if (!exit_code_) {
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  close(from_);
}

void ChildProcess::write_line(const std::string& line) const {
  const std::string text = line + "\n";
  if (write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw std::runtime_error("the program does not read its input");
  }
}

std::optional<std::string> ChildProcess::read_line(std::chrono::milliseconds timeout) {
  const auto give_up = Clock::now() + timeout;
  for (;;) {
    if (const auto end = pending_.find('\n'); end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return line;
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(give_up - Clock::now()).count();
    pollfd wanted{from_, POLLIN, 0};
    if (left < 0 || poll(&wanted, 1, static_cast<int>(left)) <= 0) {
      return std::nullopt;
    }
    std::array<char, 65536> part{};
    const ssize_t got = read(from_, part.data(), part.size());
    if (got <= 0) {
      return std::nullopt;
    }
    pending_.append(part.data(), static_cast<std::size_t>(got));
  }
}

void ChildProcess::close_input() {
  if (to_ >= 0) {
    close(to_);
    to_ = -1;
  }
}

void ChildProcess::send_signal(int signal) const { kill(id_, signal); }

std::optional<int> ChildProcess::wait_for_exit(std::chrono::milliseconds timeout) {
  const auto give_up = Clock::now() + timeout;
  while (!exit_code_) {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) == id_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (Clock::now() > give_up) {
      return std::nullopt;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  return exit_code_;
}

}  // namespace meridian::process
