#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

/// A client that keeps to no protocol.
class RudeClient {
 public:
  explicit RudeClient(const std::string& path)
      : descriptor_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    connected_ = connect(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~RudeClient() { close(descriptor_); }
  RudeClient(const RudeClient&) = delete;
  RudeClient& operator=(const RudeClient&) = delete;

  bool connected() const { return connected_; }
  void Say(const std::string& bytes) {
    [[maybe_unused]] const auto sent =
        send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  void Say(const v1::Envelope& envelope) {
    const std::string bytes = envelope.SerializeAsString();
    std::string frame(4, '\0');
    for (int i = 0; i < 4; ++i) frame[i] = static_cast<char>(bytes.size() >> (8 * i));
    Say(frame + bytes);
  }
  /// The other side closed; reads away what it said.
  bool Closed() {
    char bytes[4096];
    ssize_t size = 0;
    while ((size = recv(descriptor_, bytes, sizeof(bytes), MSG_DONTWAIT)) > 0) {
    }
    return size == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
  }

 private:
  int descriptor_;
  bool connected_ = false;
};

v1::Envelope Hello() {
  v1::Envelope hello;
  hello.mutable_hello()->set_protocol_major(1);
  hello.mutable_hello()->set_role(v1::ROLE_VIEW);
  hello.mutable_hello()->set_client_name("rude");
  return hello;
}

class ServiceFault : public Fault {
 protected:
  Device& StartWithWiimote(std::uint64_t seed) {
    Device& device = bench.Plug(std::make_shared<WiimoteModel>(seed));
    EXPECT_TRUE(bench.Start());
    EXPECT_TRUE(bench.UntilLive(device));
    return device;
  }
  /// The well-behaved client got every sample of the device, 100 a second.
  void ExpectUndisturbed(Device& device) {
    bench.Run(0.3);  // A sample that a stall held back would come now.
    EXPECT_TRUE(bench.gaps().empty());
    ExpectAllAtRest(device, 50);
    const auto& samples = Motion(device);
    for (std::size_t i = 1; i < samples.size(); ++i) {
      ASSERT_EQ(samples[i].report_count(), samples[i - 1].report_count() + 1);
    }
  }
  std::string Socket() const { return bench.folder() + "/sensor.sock"; }
};

#define FOOTING_SERVICE_FAULT(name)    \
  class name : public ServiceFault {}; \
  TEST_F(name, IsSurvived)

FOOTING_SERVICE_FAULT(Fault57ClientThatNeverReads) {
  Device& device = StartWithWiimote(57);
  const std::int64_t before = bench.MemoryBytes();
  std::vector<std::unique_ptr<RudeClient>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<RudeClient>(Socket()));
    ASSERT_TRUE(clients.back()->connected());
    clients.back()->Say(Hello());
    v1::Envelope subscribe;
    subscribe.mutable_subscribe()->set_policy(v1::QUEUE_POLICY_DROP_OLDEST);
    subscribe.mutable_subscribe()->set_queue_ticks(64);
    clients.back()->Say(subscribe);
  }
  bench.seen().Forget();
  bench.Run(1);
  // And all of it again and again: more than the kernel keeps for a socket.
  v1::Envelope again;
  again.mutable_refill()->set_from_sequence(1);
  again.mutable_refill()->set_to_sequence(1'000'000);
  for (const auto& client : clients) {
    for (int i = 0; i < 12; ++i) client->Say(again);
  }
  bench.Run(0.2);
  ASSERT_TRUE(bench.UntilSamples(device, 80));
  ExpectUndisturbed(device);
  EXPECT_LT(bench.MemoryBytes() - before, 32 << 20);
}

FOOTING_SERVICE_FAULT(Fault58GarbageAndHugeLengths) {
  Device& device = StartWithWiimote(58);
  bench.seen().Forget();
  const std::int64_t before = bench.MemoryBytes();
  std::vector<std::string> rubbish = {
      std::string("\xff\xff\xff\xff garbage", 12), std::string("\xff\xff\xff\x7f", 4),
      std::string("GET / HTTP/1.1\r\n\r\n"), std::string(4, '\0') + "x",
      std::string("\x04\x00\x00\x00\xff\xff\xff\xff", 8),
      // A field of 2 GiB announced inside a frame of 8 bytes.
      std::string("\x08\x00\x00\x00\x0a\xff\xff\xff\xff\x07\x00\x00", 12)};
  for (const std::string& one : rubbish) {
    RudeClient client(Socket());
    ASSERT_TRUE(client.connected());
    client.Say(one);
    EXPECT_TRUE(bench.Within(2, [&] { return client.Closed(); })) << one;  // Not by Hello's 3 s.
  }
  ASSERT_TRUE(bench.UntilSamples(device, 60));
  ExpectUndisturbed(device);
  EXPECT_LT(bench.MemoryBytes() - before, 32 << 20);
}

FOOTING_SERVICE_FAULT(Fault59ClientsThatVanishHalfWay) {
  Device& device = StartWithWiimote(59);
  bench.seen().Forget();
  const std::size_t before = bench.Descriptors();
  for (int i = 0; i < 60; ++i) {
    RudeClient client(Socket());
    ASSERT_TRUE(client.connected());
    if (i % 3 == 0) client.Say(std::string("\x20\x00\x00\x00\x0a\x08", 6));  // Half a frame.
    if (i % 3 == 1) client.Say(Hello());                                     // Gone at Welcome.
    bench.Run(0.01);
  }
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  ExpectUndisturbed(device);
  // At once, not when they are missed.
  EXPECT_TRUE(bench.Within(2, [&] { return bench.Descriptors() <= before; }))
      << bench.Descriptors() << " of " << before;
}

FOOTING_SERVICE_FAULT(Fault60SecondInstance) {
  Device& device = StartWithWiimote(60);
  bench.Run(0.2);
  bench.seen().Forget();
  const std::size_t writes = device.outputs().size();
  const std::string socket = bench.folder() + "/second.sock";
  auto second = bench.Run({"footingd", "--listen", "unix:" + socket, "--source", "hid"}, "second");
  ASSERT_TRUE(bench.Until(
      [&] { return second->Output().find("belongs to another footingd") != std::string::npos; }));
  bench.Run(0.3);
  EXPECT_EQ(device.outputs().size(), writes);  // It kept its hands off.
  ExpectUndisturbed(device);
  // On the same socket a third one says so and ends.
  auto third = bench.Run({"footingd", "--listen", bench.Address(), "--source", "hid"}, "third");
  ASSERT_TRUE(bench.Until([&] { return third->Ended().has_value(); }));
  EXPECT_NE(*third->Ended(), 0);
  EXPECT_NE(third->Output().find("in use by another server"), std::string::npos);
  // The first ends: the second takes over.
  EXPECT_EQ(bench.Stop(), 0);
  EXPECT_TRUE(bench.Until(
      [&] { return second->Output().find("attached as device 1") != std::string::npos; }));
  second->Signal(SIGTERM);
  EXPECT_TRUE(bench.Until([&] { return second->Ended().has_value(); }));
  EXPECT_EQ(*second->Ended(), 0);
}

FOOTING_SERVICE_FAULT(Fault61RestartWithADeviceInItsHandshake) {
  Device& device = bench.Plug(std::make_shared<WiimoteModel>(61));
  device.incoming = [](std::span<const std::uint8_t> report) { return report[0] == 0x17; };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.Until([&] { return device.Outputs(0x17) > 0; }));
  EXPECT_EQ(bench.Stop(), 0);
  // The answers to the questions of the one before come to the one after.
  device.incoming = nullptr;
  ASSERT_TRUE(bench.Restart({"--set", "default_rig=\"other\""}));
  Report late = {0x21, 0, 0, 0xf0, 0x00, 0x00};
  late.resize(22, 0x77);
  device.SendRaw(late);
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  ExpectAllAtRest(device, 20);
  EXPECT_EQ(Status(device).rig(), "other");
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

FOOTING_SERVICE_FAULT(Fault62TerminationInAHandshake) {
  // Stuck in each of the steps: no status, no memory, no acknowledgement of the mode.
  for (const std::uint8_t stuck : {0x15, 0x17, 0x12}) {
    Device& device = bench.Plug(std::make_shared<WiimoteModel>(62 + stuck));
    device.incoming = [stuck](std::span<const std::uint8_t> report) { return report[0] == stuck; };
    ASSERT_TRUE(bench.Restart());
    ASSERT_TRUE(bench.Until([&] { return device.Outputs(stuck) > 0; }));
    const std::int64_t from_ns = clock::MonotonicNs();
    EXPECT_EQ(bench.Stop(), 0) << int{stuck};
    EXPECT_LT(clock::MonotonicNs() - from_ns, 1'000'000'000);
    EXPECT_FALSE(std::filesystem::exists(Socket()));
    bench.Unplug(device);
  }
}

/// The service manager's side of sd_notify(3).
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path)
      : descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    setenv("WATCHDOG_USEC", "400000", 1);
    unsetenv("WATCHDOG_PID");
  }
  ~NotifySocket() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(descriptor_);
  }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Times that the watchdog was fed since the last call.
  int Beats() {
    int beats = 0;
    char bytes[1024];
    ssize_t size = 0;
    while ((size = recv(descriptor_, bytes, sizeof(bytes), 0)) > 0) {
      beats += std::string(bytes, static_cast<std::size_t>(size)) == "WATCHDOG=1" ? 1 : 0;
    }
    return beats;
  }

 private:
  int descriptor_;
};

FOOTING_SERVICE_FAULT(Fault65DriverThatKeepsAThread) {
  NotifySocket manager(bench.folder() + "/notify");
  Device& device = StartWithWiimote(65);
  bench.Run(1);
  EXPECT_GE(manager.Beats(), 3);
  Device& stuck = bench.Plug(std::make_shared<WiimoteModel>(66));
  stuck.node().page().write_blocks = 1;
  const auto said = [&] {
    manager.Beats();  // The kernel keeps ten of them, and then the sender waits.
    return bench.LogLines("is stuck: the watchdog is not fed") == 1;
  };
  ASSERT_TRUE(bench.Until(said, 25));
  manager.Beats();
  bench.Run(1);
  EXPECT_EQ(manager.Beats(), 0);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 60));
  ExpectUndisturbed(device);  // The others go on until the service manager ends it.
  stuck.node().page().write_blocks = 0;
  EXPECT_TRUE(bench.Until([&] { return manager.Beats() > 0; }));
}

FOOTING_SERVICE_FAULT(Fault63DiskFullForTheRecorder) {
  Device& device = StartWithWiimote(63);
  bench.seen().Forget();
  const std::string file = bench.folder() + "/full.mcap";
  // A file may not grow beyond 32 blocks of 1 KiB.
  Program recorder(
      {"/bin/bash", "-c",
       "ulimit -f 32; trap '' XFSZ; exec " FOOTING_BINARY_DIR "/bin/footing-log record --connect " +
           bench.Address() + " --out " + file},
      {}, bench.folder() + "/recorder.log");
  ASSERT_TRUE(bench.Until([&] { return recorder.Ended().has_value(); }));
  EXPECT_EQ(WEXITSTATUS(*recorder.Ended()), 1) << recorder.Output();
  EXPECT_NE(recorder.Output().find("File too large"), std::string::npos) << recorder.Output();
  EXPECT_NE(recorder.Output().find(file), std::string::npos) << recorder.Output();
  ASSERT_TRUE(bench.UntilSamples(device, 50));
  ExpectUndisturbed(device);
  EXPECT_GT(std::filesystem::file_size(file), 0u);
}

}  // namespace
}  // namespace footing::device_faults
