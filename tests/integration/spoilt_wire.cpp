// SPDX-License-Identifier: Apache-2.0
/// spoilt_wire INTERFACE...: brings every frame that comes to one of the interfaces to the others,
/// as a hub does, and spoils IPv4 on the way. Lines of its input say how: delay ms, jitter ms, and
/// of 100 frames how many are lost, come twice, past others, or with a wrong bit. At the end of its
/// input it prints what it did.
#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/if_ether.h>
#include <netpacket/packet.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <queue>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kLate{1};  ///< what is held back for less does not count

struct Frame {
  Clock::time_point due;
  std::uint64_t order = 0;
  std::size_t from = 0;
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] bool operator<(const Frame& other) const {  // the earliest is on top
    return std::tie(other.due, other.order) < std::tie(due, order);
  }
};

class SpoiltWire {
 public:
  void add(const char* interface) {
    sockaddr_ll address{};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(ETH_P_ALL);
    address.sll_ifindex = static_cast<int>(if_nametoindex(interface));
    const int end = ::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(ETH_P_ALL));
    if (::bind(end, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      std::perror(interface);
      std::exit(1);
    }
    ends_.push_back({end, POLLIN, 0});
  }

  void run() {
    ends_.push_back({STDIN_FILENO, POLLIN, 0});
    while (has_input_) {
      timespec wait{1, 0};
      if (!in_flight_.empty()) {
        const auto left = std::max(Clock::duration{}, in_flight_.top().due - Clock::now());
        wait = {left / std::chrono::seconds(1),
                std::chrono::nanoseconds(left % std::chrono::seconds(1)).count()};
      }
      (void)::ppoll(ends_.data(), ends_.size(), &wait, nullptr);
      if (ends_.back().revents != 0) listen();
      for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
        if ((ends_[i].revents & POLLIN) != 0) receive(i);
      }
      deliver();
    }
    std::printf("%d frames, %d lost, %d twice, %d past others, %d with a wrong bit, %d late\n",
                frames_, lost_, twice_, past_others_, wrong_, late_);
  }

 private:
  void listen() {
    std::array<char, 256> line{};
    has_input_ = ::read(STDIN_FILENO, line.data(), line.size() - 1) > 0;
    if (!has_input_) return;
    (void)std::sscanf(line.data(), "%lf %lf %lf %lf %lf %lf", &delay_ms_, &jitter_ms_, &lost_share_,
                      &twice_share_, &past_share_, &wrong_share_);
  }

  void receive(std::size_t from) {
    std::array<std::uint8_t, 65536> bytes;
    sockaddr_ll address{};
    socklen_t size = sizeof address;
    const ssize_t n = ::recvfrom(ends_[from].fd, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&address), &size);
    if (n < ETH_HLEN || address.sll_pkttype == PACKET_OUTGOING) return;
    Frame frame{Clock::now(), ++order_, from, {bytes.begin(), bytes.begin() + n}};
    if (address.sll_protocol != htons(ETH_P_IP)) return in_flight_.push(frame);
    ++frames_;
    if (comes_to_pass(lost_share_, lost_)) return;
    if (comes_to_pass(wrong_share_, wrong_)) {
      const std::size_t at =
          std::uniform_int_distribution<std::size_t>(ETH_HLEN, frame.bytes.size() - 1)(engine_);
      frame.bytes[at] = static_cast<std::uint8_t>(frame.bytes[at] ^ (1U << (engine_() % 8)));
    }
    const auto arrived = frame.due;
    if (!comes_to_pass(past_share_, past_others_)) frame.due += late();
    late_ += frame.due - arrived >= kLate ? 1 : 0;
    if (comes_to_pass(twice_share_, twice_)) in_flight_.push(frame);
    in_flight_.push(frame);
  }

  [[nodiscard]] bool comes_to_pass(double share, int& count) {
    const bool is_so = std::uniform_real_distribution<double>(0, 100)(engine_) < share;
    count += is_so ? 1 : 0;
    return is_so;
  }

  [[nodiscard]] Clock::duration late() {
    const double more = std::uniform_real_distribution<double>(-1, 1)(engine_) * jitter_ms_;
    return std::chrono::microseconds(std::llround(1e3 * std::max(0.0, delay_ms_ + more)));
  }

  void deliver() {
    for (const auto now = Clock::now(); !in_flight_.empty() && in_flight_.top().due <= now;) {
      const Frame& frame = in_flight_.top();
      for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
        if (i != frame.from) {
          (void)::send(ends_[i].fd, frame.bytes.data(), frame.bytes.size(), MSG_DONTWAIT);
        }
      }
      in_flight_.pop();
    }
  }

  std::vector<pollfd> ends_;
  std::priority_queue<Frame> in_flight_;
  std::mt19937 engine_{1};
  std::uint64_t order_ = 0;
  bool has_input_ = true;
  double delay_ms_ = 0, jitter_ms_ = 0;
  double lost_share_ = 0, twice_share_ = 0, past_share_ = 0, wrong_share_ = 0;
  int frames_ = 0, lost_ = 0, twice_ = 0, past_others_ = 0, wrong_ = 0, late_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  // Every cycle of the machine passes here: where the right is there, before what is no machine.
  const sched_param before_others{.sched_priority = 60};
  (void)::sched_setscheduler(0, SCHED_FIFO, &before_others);
  SpoiltWire wire;
  for (int i = 1; i < argc; ++i) wire.add(argv[i]);
  wire.run();
  return 0;
}
