// SPDX-License-Identifier: Apache-2.0
// A neighbour of another vendor: reads the topics of `meridian bridge ros2` with Fast DDS and its
// CDR, with the quality of service of ROS 2's subscriptions, and prints what it got.
//
//     fast_reader DOMAIN JOINT_STATES: ends after so many joint states, or after 30 s
#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <stdio.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

/// A message as it came: the payload with its encapsulation.
using Payload = std::vector<char>;

/// Any type, by its name alone.
class AnyType : public fast::TopicDataType {
 public:
  explicit AnyType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1 << 20;
    m_isGetKeyDefined = false;
  }
  bool serialize(void*, rtps::SerializedPayload_t*) override { return false; }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    const auto* const begin = reinterpret_cast<const char*>(payload->data);
    static_cast<Payload*>(data)->assign(begin, begin + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Payload; }
  void deleteData(void* data) override { delete static_cast<Payload*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// One topic: prints every message in the order of arrival.
class Printer : public fast::DataReaderListener {
 public:
  using Print = void (*)(eprosima::fastcdr::Cdr&);
  explicit Printer(Print print) : print_(print) {}

  void on_data_available(fast::DataReader* reader) override {
    Payload payload;
    fast::SampleInfo info;
    while (reader->take_next_sample(&payload, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      eprosima::fastcdr::FastBuffer buffer(payload.data(), payload.size());
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      cdr.read_encapsulation();
      ::flockfile(stdout);  // a line is one reader's
      print_(cdr);
      ::funlockfile(stdout);
      ++count;
    }
  }
  std::atomic<int> count{0};

 private:
  Print print_;
};

std::int64_t read_header(eprosima::fastcdr::Cdr& cdr, std::string* frame_id = nullptr) {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::string frame;
  cdr >> seconds >> nanoseconds >> frame;
  if (frame_id != nullptr) *frame_id = frame;
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

void print_joint_state(eprosima::fastcdr::Cdr& cdr) {
  const std::int64_t stamp = read_header(cdr);
  std::vector<std::string> names;
  std::vector<double> position, velocity, effort;
  cdr >> names >> position >> velocity >> effort;
  std::printf("joint_state %lld %zu", static_cast<long long>(stamp), velocity.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::printf(" %s %.17g", names[i].c_str(), position[i]);
  }
  for (const double value : velocity) std::printf(" %.17g", value);
  std::puts("");
}

void print_transforms(eprosima::fastcdr::Cdr& cdr, const char* word) {
  std::uint32_t count = 0;
  cdr >> count;
  std::printf("%s", word);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::string parent, child;
    (void)read_header(cdr, &parent);
    cdr >> child;
    std::printf(" %s %s", parent.c_str(), child.c_str());
    double number = 0;
    for (int i = 0; i < 7; ++i) {  // translation, then the quaternion x y z w
      cdr >> number;
      std::printf(" %.17g", number);
    }
  }
  std::puts("");
}

void print_moving(eprosima::fastcdr::Cdr& cdr) { print_transforms(cdr, "tf"); }
void print_fixed(eprosima::fastcdr::Cdr& cdr) { print_transforms(cdr, "tf_static"); }

void print_description(eprosima::fastcdr::Cdr& cdr) {
  std::string urdf;
  cdr >> urdf;
  std::printf("robot_description %zu %s\n", urdf.size(), urdf.substr(0, 21).c_str());
}

void print_diagnostics(eprosima::fastcdr::Cdr& cdr) {
  (void)read_header(cdr);
  std::uint32_t count = 0;
  cdr >> count;
  std::uint8_t level = 0;
  std::string name, message;
  if (count > 0) cdr >> level >> name >> message;
  std::printf("diagnostics %u %u %s: %s\n", count, level, name.c_str(), message.c_str());
}

struct Subscription {
  const char *topic, *type;
  int depth;
  bool is_kept;
  Printer::Print print;
};

constexpr Subscription kSubscriptions[] = {
    {"rt/joint_states", "sensor_msgs::msg::dds_::JointState_", 1000, false, &print_joint_state},
    {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_", 1000, false, &print_moving},
    {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", 1, true, &print_fixed},
    {"rt/robot_description", "std_msgs::msg::dds_::String_", 1, true, &print_description},
    {"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_", 10, false,
     &print_diagnostics}};

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  const auto domain = static_cast<std::uint32_t>(std::atoi(arguments[1]));
  const int wanted = std::atoi(arguments[2]);
  static char all[1 << 22];  // nobody reads before the end
  std::setvbuf(stdout, all, _IOFBF, sizeof all);
  auto* const factory = fast::DomainParticipantFactory::get_instance();
  // This host alone, as ROS_LOCALHOST_ONLY=1 has it.
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back("127.0.0.1");
  fast::DomainParticipantQos participant_qos;
  participant_qos.transport().use_builtin_transports = false;
  participant_qos.transport().user_transports.push_back(udp);
  auto* const participant = factory->create_participant(domain, participant_qos);
  if (participant == nullptr) return 1;
  auto* const subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
  std::vector<Printer*> printers;
  for (const Subscription& wish : kSubscriptions) {
    const fast::TypeSupport type(new AnyType(wish.type));
    type.register_type(participant);
    auto* const topic = participant->create_topic(wish.topic, wish.type, fast::TOPIC_QOS_DEFAULT);
    fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        wish.is_kept ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = wish.depth;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    printers.push_back(new Printer(wish.print));
    if (topic == nullptr || subscriber->create_datareader(topic, qos, printers.back()) == nullptr) {
      return 1;
    }
  }
  std::puts("ready");
  std::fflush(stdout);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (printers[0]->count < wanted && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // one too many would be seen
  std::printf("end %d\n", printers[0]->count.load());
  std::fflush(stdout);
  std::_Exit(0);
}
