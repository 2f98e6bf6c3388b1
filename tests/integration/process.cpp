// SPDX-License-Identifier: Apache-2.0
#include "integration/process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

namespace meridian::test {
namespace {

/// In a child before it becomes its program.
void go_to(const HostEnvironment& host) {
  const int network = ::open(host.network.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_there = ::setns(network, CLONE_NEWNET) == 0 &&
                        (host.uptime_ahead_s == 0 || set_uptime_ahead(host.uptime_ahead_s));
  if (!is_there) ::_exit(126);
  if (!host.dds.empty()) ::setenv("CYCLONEDDS_URI", host.dds.c_str(), 1);
}

}  // namespace

bool set_uptime_ahead(long seconds) {
  if (::unshare(CLONE_NEWTIME) != 0) return false;
  const std::string offset = "monotonic " + std::to_string(seconds) + " 0\n";
  const int file = ::open("/proc/self/timens_offsets", O_WRONLY | O_CLOEXEC);
  return ::write(file, offset.data(), offset.size()) == static_cast<ssize_t>(offset.size());
}

bool eventually(const std::function<bool()>& condition, milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  do {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(2));
  } while (std::chrono::steady_clock::now() < end);
  return condition();
}

InputPipe::InputPipe() {
  std::array<int, 2> ends{-1, -1};
  (void)::pipe2(ends.data(), O_CLOEXEC);
  read_end_ = ends[0];
  write_end_ = ends[1];
}

InputPipe::~InputPipe() {
  close();
  ::close(read_end_);
}

void InputPipe::write(const std::string& text) const {
  (void)!::write(write_end_, text.data(), text.size());
}

void InputPipe::close() {
  if (write_end_ >= 0) ::close(write_end_);
  write_end_ = -1;
}

Terminal::Terminal() : our_end_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)) {
  (void)::grantpt(our_end_);
  (void)::unlockpt(our_end_);
  std::array<char, 64> name{};
  (void)::ptsname_r(our_end_, name.data(), name.size());
  process_end_ = ::open(name.data(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
}

Terminal::~Terminal() {
  ::close(process_end_);
  ::close(our_end_);
}

const std::string& Terminal::shown() {
  std::array<char, 4096> buffer{};
  for (ssize_t n = 1; n > 0;) {
    n = ::read(our_end_, buffer.data(), buffer.size());
    if (n > 0) shown_.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return shown_;
}

Process::Process(const std::vector<std::string>& arguments, std::filesystem::path log,
                 const InputPipe* input, const Terminal* terminal)
    : log_(std::move(log)) {
  std::vector<std::string> words = arguments;
  words[0] = std::string(MERIDIAN_BINARY_DIR) + "/bin/" + words[0];
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const HostEnvironment* const host = host_of ? host_of(arguments) : nullptr;
  pid_ = ::fork();
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int file = ::open(log_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::dup2(file, STDOUT_FILENO);
  ::dup2(file, STDERR_FILENO);
  if (terminal != nullptr) ::dup2(terminal->process_end(), STDOUT_FILENO);
  if (input != nullptr) ::dup2(input->read_end(), STDIN_FILENO);
  if (host != nullptr) go_to(*host);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

Process::~Process() {
  if (!exit_code_) {
    send_signal(SIGKILL);
    (void)wait(milliseconds(5000));
  }
  // Where the program was built under a sanitizer, what that found is a failure of this test.
  const std::string all = said();
  for (const char* finding : {"Sanitizer: ", "runtime error: "}) {
    EXPECT_EQ(all.find(finding), std::string::npos) << all;
  }
}

void Process::send_signal(int signal) const {
  if (!exit_code_) ::kill(pid_, signal);
}

std::optional<int> Process::wait(milliseconds patience) {
  (void)eventually(
      [this] {
        int status = 0;
        if (exit_code_ || ::waitpid(pid_, &status, WNOHANG) != pid_) return exit_code_.has_value();
        exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return true;
      },
      patience);
  return exit_code_;
}

std::string Process::said() const {
  if (!std::filesystem::is_regular_file(log_)) return {};  // a pipe that nobody is to read
  std::ostringstream all;
  all << std::ifstream(log_).rdbuf();
  return all.str();
}

}  // namespace meridian::test
