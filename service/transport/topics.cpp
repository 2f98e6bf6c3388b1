// SPDX-License-Identifier: Apache-2.0
#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <string>

#include "service/transport/convert/convert.hpp"
#include "service/transport/entity.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::dds {
namespace {

/// No write waits for a reader that does not acknowledge: what it has not taken by then is lost to
/// it alone (docs/topics.md).
constexpr dds_duration_t kMaxBlocking = 0;
/// No false alarm by host stalls of 5 ms; receivers check freshness by sequence and their own
/// clock.
constexpr dds_duration_t kCyclicDeadline = DDS_MSECS(20);
constexpr dds_duration_t kSetpointLease = DDS_MSECS(100);

/// The quality of service of the topics, by group (docs/topics.md).
enum class Quality : std::uint8_t {
  kStream,    ///< reliable; writers keep more than credits allow to be sent, readers all
  kVerb,      ///< reliable; writers keep the newest kKeptVerbs, readers all
  kLatest,    ///< reliable, transient local, keep last 1: late joiners get the newest
  kOrder,     ///< as kLatest; readers keep those of several senders
  kClaim,     ///< the same, fewer of them
  kSnapshot,  ///< reliable, keep last 1
  kCyclic,    ///< best effort, keep last 1, deadline
  kSetpoint,  ///< as kCyclic, with manual liveliness
  kJog        ///< best effort, keep last 1
};

enum class Side : std::uint8_t { kWriter, kReader };

/// Samples that a writer keeps until every reader has acknowledged them. Batches: those of the
/// whole block queue and as many more (8192 blocks are 256 batches).
constexpr std::int32_t kKeptBatches = 512, kKeptVerbs = 128;
/// Samples that wait in a reader where several may send: one does not hide another.
constexpr std::int32_t kSenders = 16, kOrders = 64;

/// How many samples are kept; 0: all.
[[nodiscard]] std::int32_t depth_of(Quality quality, Side side) noexcept {
  const bool is_reader = side == Side::kReader;
  switch (quality) {
    case Quality::kStream:
      return is_reader ? 0 : kKeptBatches;
    case Quality::kVerb:
      return is_reader ? 0 : kKeptVerbs;
    case Quality::kOrder:
      return is_reader ? kOrders : 1;
    case Quality::kClaim:
    case Quality::kJog:
      return is_reader ? kSenders : 1;
    default:
      return 1;
  }
}

/// Readers never have resource limits: one that filled up would stop every topic of its process.
Qos make_qos(Quality quality, Side side) {
  Qos qos(dds_create_qos());
  const bool is_latest =
      quality == Quality::kLatest || quality == Quality::kOrder || quality == Quality::kClaim;
  const bool is_reliable = quality == Quality::kStream || quality == Quality::kVerb || is_latest ||
                           quality == Quality::kSnapshot;
  dds_qset_reliability(qos.get(),
                       is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kMaxBlocking);
  const std::int32_t depth = depth_of(quality, side);
  if (depth == 0) {
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  }
  if (is_latest) {
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  if (quality == Quality::kCyclic || quality == Quality::kSetpoint) {
    dds_qset_deadline(qos.get(), kCyclicDeadline);
  }
  if (quality == Quality::kSetpoint) {
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, kSetpointLease);
  }
  return qos;
}

template <class Message>
struct Topic;

#define MERIDIAN_TOPIC(MESSAGE, WIRE, NAME, QUALITY)             \
  template <>                                                    \
  struct Topic<MESSAGE> {                                        \
    using Wire = meridian_wire_##WIRE;                           \
    static constexpr const char* kName = "meridian/" NAME;       \
    static constexpr Quality kQuality = Quality::QUALITY;        \
    static const dds_topic_descriptor_t* descriptor() noexcept { \
      return &meridian_wire_##WIRE##_desc;                       \
    }                                                            \
  }

MERIDIAN_TOPIC(Batch, ClBatch, "cl_batch", kStream);
MERIDIAN_TOPIC(SessionRequest, ClSession, "cl_session", kStream);
MERIDIAN_TOPIC(Credit, ClCredit, "cl_credit", kVerb);
MERIDIAN_TOPIC(CommandRequest, Command, "command", kVerb);
MERIDIAN_TOPIC(Reply, Reply, "reply", kVerb);
MERIDIAN_TOPIC(Jog, Jog, "jog", kJog);
MERIDIAN_TOPIC(Enabling, Enabling, "enabling", kJog);
MERIDIAN_TOPIC(SetpointSample, Setpoint, "setpoint", kSetpoint);
MERIDIAN_TOPIC(DriveCommand, DriveCommand, "drive_command", kOrder);
MERIDIAN_TOPIC(DriveFeedback, Feedback, "feedback", kCyclic);
MERIDIAN_TOPIC(Action, Action, "action", kVerb);
MERIDIAN_TOPIC(ActionDone, ActionDone, "action_done", kVerb);
MERIDIAN_TOPIC(Status, Status, "status", kLatest);
MERIDIAN_TOPIC(MachineInfo, Machine, "machine", kClaim);
MERIDIAN_TOPIC(Latency, Latency, "latency", kSnapshot);

#undef MERIDIAN_TOPIC

[[nodiscard]] std::string describe(dds_return_t code) {
  if (code != DDS_RETCODE_NOT_ALLOWED_BY_SECURITY) return dds_strretcode(-code);
  return "the permissions of this identity do not allow it; use the configuration of a role that "
         "may, and name the machine (--machine-name), for that is what permissions are given for";
}

/// Creates the topic with an endpoint on it by `make`; both live until the participant goes.
template <class Message, class Make>
dds_entity_t make_endpoint(Participant& participant, Side side, dds_entity_t& topic, Make make) {
  using T = Topic<Message>;
  topic = dds_create_topic(participant.handle(), T::descriptor(), T::kName, nullptr, nullptr);
  const Qos qos = make_qos(T::kQuality, side);
  const dds_entity_t endpoint = topic < 0 ? topic : make(topic, qos.get());
  if (endpoint < 0) {
    throw DdsError(std::string("DDS topic ") + T::kName + " cannot be used: " + describe(endpoint));
  }
  return endpoint;
}

}  // namespace

template <class Message>
struct Reader<Message>::Impl {
  dds_entity_t topic = 0, reader = 0;
  typename Topic<Message>::Wire wire{};
  std::function<void(Reader&)> on_data;
  Reader* owner = nullptr;

  static void call(dds_entity_t, void* self) {
    auto* impl = static_cast<Impl*>(self);
    impl->on_data(*impl->owner);
  }
};

template <class Message>
Reader<Message>::Reader(Participant& participant, std::function<void(Reader&)> on_data, int depth,
                        Delivery delivery)
    : impl_(std::make_unique<Impl>()) {
  impl_->on_data = std::move(on_data);
  impl_->owner = this;
  impl_->reader = make_endpoint<Message>(
      participant, Side::kReader, impl_->topic, [&](dds_entity_t topic, dds_qos_t* qos) {
        if (depth > 0) dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
        if (delivery == Delivery::kNewest) {
          dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
          dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
        }
        return dds_create_reader(participant.subscriber(), topic, qos, nullptr);
      });
  if (impl_->on_data) {
    dds_listener_t* listener = dds_create_listener(impl_.get());
    dds_lset_data_available(listener, &Impl::call);
    (void)dds_set_listener(impl_->reader, listener);
    dds_delete_listener(listener);
  }
}

template <class Message>
Reader<Message>::~Reader() {
  dds_delete(impl_->reader);
  dds_delete(impl_->topic);
}

template <class Message>
bool Reader<Message>::take(Message& message, SampleInfo& info) noexcept {
  void* sample = &impl_->wire;
  dds_sample_info_t wire_info;
  if (dds_take(impl_->reader, &sample, &wire_info, 1, 1) != 1) return false;
  info.is_valid = wire_info.valid_data;
  info.is_alive = wire_info.instance_state == DDS_IST_ALIVE;
  info.source = wire_info.publication_handle;
  from_wire(impl_->wire, message);
  return true;
}

template <class Message>
bool Reader<Message>::take(Message& message) noexcept {
  SampleInfo info;
  while (take(message, info)) {
    if (info.is_valid) return true;
  }
  return false;
}

template <class Message>
int Reader<Message>::matched_writers() const noexcept {
  return std::max(0, dds_get_matched_publications(impl_->reader, nullptr, 0));
}

template <class Message>
bool Reader<Message>::has_source(std::uint64_t source) const noexcept {
  std::array<dds_instance_handle_t, 1024> writers{};
  const auto count = dds_get_matched_publications(impl_->reader, writers.data(), writers.size());
  const auto end = writers.begin() + std::clamp<int>(count, 0, static_cast<int>(writers.size()));
  return std::find(writers.begin(), end, source) != end;
}

template <class Message>
std::int32_t Reader<Message>::handle() const noexcept {
  return impl_->reader;
}

template <class Message>
struct Writer<Message>::Impl {
  dds_entity_t topic = 0, writer = 0;
  typename Topic<Message>::Wire wire{};
};

template <class Message>
Writer<Message>::Writer(Participant& participant) : impl_(std::make_unique<Impl>()) {
  impl_->writer = make_endpoint<Message>(
      participant, Side::kWriter, impl_->topic, [&](dds_entity_t topic, dds_qos_t* qos) {
        return dds_create_writer(participant.publisher(), topic, qos, nullptr);
      });
}

template <class Message>
Writer<Message>::~Writer() {
  dds_delete(impl_->writer);
  dds_delete(impl_->topic);
}

template <class Message>
void Writer<Message>::register_instance(const Message& message) noexcept {
  to_wire(message, impl_->wire);
  dds_instance_handle_t handle = 0;
  (void)dds_register_instance(impl_->writer, &handle, &impl_->wire);
}

template <class Message>
bool Writer<Message>::write(const Message& message) noexcept {
  to_wire(message, impl_->wire);
  return dds_write(impl_->writer, &impl_->wire) == DDS_RETCODE_OK;
}

template <class Message>
int Writer<Message>::matched_readers() const noexcept {
  return std::max(0, dds_get_matched_subscriptions(impl_->writer, nullptr, 0));
}

template <class Message>
std::int32_t Writer<Message>::handle() const noexcept {
  return impl_->writer;
}

#define MERIDIAN_INSTANTIATE(MESSAGE) \
  template class Reader<MESSAGE>;     \
  template class Writer<MESSAGE>

MERIDIAN_INSTANTIATE(Batch);
MERIDIAN_INSTANTIATE(SessionRequest);
MERIDIAN_INSTANTIATE(Credit);
MERIDIAN_INSTANTIATE(CommandRequest);
MERIDIAN_INSTANTIATE(Reply);
MERIDIAN_INSTANTIATE(Jog);
MERIDIAN_INSTANTIATE(Enabling);
MERIDIAN_INSTANTIATE(SetpointSample);
MERIDIAN_INSTANTIATE(DriveCommand);
MERIDIAN_INSTANTIATE(DriveFeedback);
MERIDIAN_INSTANTIATE(Action);
MERIDIAN_INSTANTIATE(ActionDone);
MERIDIAN_INSTANTIATE(Status);
MERIDIAN_INSTANTIATE(MachineInfo);
MERIDIAN_INSTANTIATE(Latency);

}  // namespace meridian::dds
