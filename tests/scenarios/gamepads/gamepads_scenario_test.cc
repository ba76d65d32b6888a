// footingd as it is shipped, with simulated gamepads on its device socket.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/runtime/clock.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/wiimote.h"
#include "footing/v1/device.pb.h"

extern char** environ;

namespace footing {
namespace {

using Reports = std::vector<virtual_devices::Report>;

/// One simulated device on the device socket: answers at once, samples when it is asked to.
class SocketDevice {
 public:
  using Answer = std::function<Reports(std::span<const std::uint8_t>)>;

  SocketDevice(transport::Socket socket, const virtual_devices::Identity& identity, Answer answer)
      : answer_(std::move(answer)),
        connection_(std::move(socket), {},
                    {[this](std::string_view payload) { OnFrame(payload); },
                     [](const std::string&) {},
                     {},
                     {},
                     {}}) {
    connection_.Start();
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(1);
    attach.set_bus(identity.bus);
    attach.set_vendor(identity.vendor);
    attach.set_product(identity.product);
    attach.set_name(identity.name);
    attach.set_serial(identity.serial);
    connection_.Send(envelope.SerializeAsString());
  }

  void Send(const Reports& reports) {
    for (const auto& report : reports) {
      v1::DeviceEnvelope envelope;
      v1::DeviceInputReport& input = *envelope.mutable_input_report();
      input.set_slot(1);
      input.set_sequence(++sequence_);
      input.set_report(report.data(), report.size());
      connection_.Send(envelope.SerializeAsString());
    }
  }

 private:
  void OnFrame(std::string_view payload) {
    v1::DeviceEnvelope envelope;
    ASSERT_TRUE(envelope.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
    const std::string& bytes = envelope.output().report();
    const std::vector<std::uint8_t> report(bytes.begin(), bytes.end());
    if (envelope.has_output()) Send(answer_(report));
  }

  Answer answer_;
  transport::FramedConnection connection_;
  std::uint64_t sequence_ = 0;
};

class Gamepads : public testing::Test {
 protected:
  Gamepads() {
    std::string name = "/tmp/footing-pads-XXXXXX";
    folder_ = mkdtemp(name.data());
    const std::string path = std::string(FOOTING_BINARY_DIR) + "/bin/footingd";
    std::vector<std::string> words = {path,       "-q",
                                      "--listen", Sensor(),
                                      "--source", "stream:" + Devices(),
                                      "--set",    "state_directory=none"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn(&daemon_, path.c_str(), nullptr, nullptr, arguments.data(), environ);
    transport::ClientOptions options;
    options.address = transport::ParseAddress(Sensor()).value();
    options.client_name = "scenario";
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) {
      for (const auto& status : tick.status().devices()) status_ = status;
      for (const auto& sample : tick.gamepad().samples()) newest_ = sample;
    };
    client_ = std::make_unique<transport::Client>(io_, options, handlers);
    client_->Start();
  }
  ~Gamepads() override {
    device_.reset();
    client_->Stop();
    io_.poll();
    kill(daemon_, SIGTERM);
    waitpid(daemon_, nullptr, 0);
    std::filesystem::remove_all(folder_);
  }

  std::string Sensor() const { return "unix:" + folder_ + "/sensor.sock"; }
  std::string Devices() const { return "unix:" + folder_ + "/devices.sock"; }

  void Attach(const virtual_devices::Identity& identity, const SocketDevice::Answer& answer) {
    bool dialling = false;
    ASSERT_TRUE(RunUntil([&] {
      if (!device_ && !dialling) {
        dialling = true;
        transport::Dial(io_, transport::ParseAddress(Devices()).value(),
                        [&, identity, answer](Result<transport::Socket> socket) {
                          dialling = false;
                          if (!socket) return;
                          device_ = std::make_unique<SocketDevice>(std::move(socket).value(),
                                                                   identity, answer);
                        });
      }
      return device_ != nullptr;
    }));
  }

  bool RunUntil(const std::function<bool()>& done, double limit_s = 60) {
    const std::int64_t end_ns = clock::MonotonicNs() + static_cast<std::int64_t>(limit_s * 1e9);
    while (!done()) {
      if (clock::MonotonicNs() > end_ns) return false;
      io_.run_for(std::chrono::milliseconds(5));
      io_.restart();
    }
    return true;
  }

  std::string folder_;
  pid_t daemon_ = 0;
  boost::asio::io_context io_;
  std::unique_ptr<transport::Client> client_;
  std::unique_ptr<SocketDevice> device_;
  v1::DeviceStatus status_;
  std::optional<v1::GamepadSample> newest_;
};

TEST_F(Gamepads, AClassicControllerInAWiimoteArrivesAsAGamepad) {
  virtual_devices::Wiimote wiimote(7);
  wiimote.Plug(virtual_devices::Accessory::kClassic, 0);
  Attach(wiimote.identity(), [&](std::span<const std::uint8_t> report) {
    return wiimote.HandleOutput(clock::MonotonicNs(), report);
  });
  ASSERT_TRUE(RunUntil([&] {
    virtual_devices::WiimoteSensors sensors;
    sensors.classic.left_x = -1;
    sensors.classic.right_trigger = 1;
    sensors.classic.buttons = 0x0010;  // A.
    device_->Send(wiimote.Sample(clock::MonotonicNs(), sensors));
    return newest_ && newest_->right_trigger() == 1;
  }));
  EXPECT_EQ(newest_->left_x(), -1);
  EXPECT_EQ(newest_->buttons(), static_cast<std::uint32_t>(v1::GAMEPAD_BUTTON_A));
  EXPECT_TRUE(newest_->simulated());
  ASSERT_TRUE(RunUntil([&] { return status_.extension() == v1::EXTENSION_CLASSIC; }));
  EXPECT_EQ(status_.kind(), v1::DEVICE_KIND_WIIMOTE);
}

TEST_F(Gamepads, AProControllerArrivesAsAGamepadWithoutARole) {
  virtual_devices::ProController pad(8);
  Attach(pad.identity(),
         [&](std::span<const std::uint8_t> report) { return pad.HandleOutput(report); });
  ASSERT_TRUE(RunUntil([&] {
    virtual_devices::ProControllerSensors sensors;
    sensors.gamepad.right_y = 0.5;
    sensors.left_stick = true;
    if (auto report = pad.Sample(sensors)) device_->Send({*report});
    return newest_.has_value();
  }));
  EXPECT_EQ(newest_->right_y(), 0.5);
  EXPECT_EQ(newest_->buttons(), static_cast<std::uint32_t>(v1::GAMEPAD_BUTTON_LEFT_STICK));
  ASSERT_TRUE(RunUntil([&] { return status_.state() == v1::DEVICE_STATE_LIVE; }));
  EXPECT_EQ(status_.kind(), v1::DEVICE_KIND_PRO_CONTROLLER);
  EXPECT_EQ(status_.role(), v1::DEVICE_ROLE_UNSPECIFIED);
  EXPECT_EQ(status_.battery_fraction(), 1);
}

}  // namespace
}  // namespace footing
