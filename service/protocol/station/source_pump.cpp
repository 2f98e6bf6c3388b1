// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/source_pump.hpp"

#include <utility>

namespace meridian::stream {

Supply supply_of(cl::ClReader& reader) {
  auto next = reader.next();
  if (!next) return {.kind = Supply::Kind::kBad, .text = next.error().text()};
  if (!*next) return {.kind = Supply::Kind::kEnd};
  return {.kind = Supply::Kind::kBlock, .block = **next};
}

SourcePump::SourcePump(int descriptor, const std::string& name, const cl::ClReaderOptions& options,
                       std::function<void()> wake)
    : buffer_(descriptor),
      stream_(&buffer_),
      wake_(std::move(wake)),
      thread_([this, name, options] { run(name, options); }) {}

SourcePump::~SourcePump() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  buffer_.stop();
  has_room_.notify_one();
  thread_.join();
}

Supply SourcePump::take() {
  const std::lock_guard lock(mutex_);
  if (supplies_.empty()) return {.kind = Supply::Kind::kWait};
  Supply supply = std::move(supplies_.front());
  supplies_.pop_front();
  has_room_.notify_one();
  return supply;
}

std::vector<cl::ClWarning> SourcePump::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

bool SourcePump::put(Supply supply) {
  std::unique_lock lock(mutex_);
  has_room_.wait(lock, [this] { return is_stopping_ || supplies_.size() < kMaxSupplies; });
  if (is_stopping_) return false;
  const bool was_empty = supplies_.empty();
  supplies_.push_back(std::move(supply));
  lock.unlock();
  if (was_empty) wake_();
  return true;
}

void SourcePump::run(const std::string& name, const cl::ClReaderOptions& options) {
  cl::ClReader reader(stream_, name, options);
  std::size_t warned = 0;
  for (bool is_going = true; is_going;) {
    Supply supply = supply_of(reader);
    for (; warned < reader.warnings().size(); ++warned) {
      const std::lock_guard lock(mutex_);
      warnings_.push_back(reader.warnings()[warned]);
    }
    const bool has_more = supply.kind == Supply::Kind::kBlock;
    is_going = put(std::move(supply)) && has_more;
  }
}

}  // namespace meridian::stream
