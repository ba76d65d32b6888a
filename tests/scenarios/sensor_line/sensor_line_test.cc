// footingd and footing-stream as they are shipped, on sockets of their own.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/net/client.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"

extern char** environ;

namespace footing {
namespace {

constexpr double kG = 9.80665;

/// One program of the build, ended with the object.
class Program {
 public:
  Program(const std::string& name, std::vector<std::string> words, const std::string& log) {
    const std::string path = std::string(FOOTING_BINARY_DIR) + "/bin/" + name;
    words.insert(words.begin(), path);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn(&process_, path.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Program() {
    if (process_ > 0) End(SIGKILL);
  }

  /// Ends it and returns its exit code; -1 when a signal ended it.
  int End(int signal_number) {
    kill(process_, signal_number);
    return Wait();
  }
  int Wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = 0;
};

class SensorLine : public testing::Test {
 protected:
  SensorLine() {
    std::string name = "/tmp/footing-line-XXXXXX";
    folder_ = mkdtemp(name.data());
    daemon_ = StartDaemon("footingd.log");
    transport::ClientOptions options;
    options.address = transport::ParseAddress(Sensor()).value();
    options.client_name = "scenario";
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { Take(tick); };
    client_ = std::make_unique<transport::Client>(io_, options, handlers);
    client_->Start();
  }
  ~SensorLine() override {
    client_->Stop();
    io_.poll();
    daemon_.reset();
    std::filesystem::remove_all(folder_);
  }

  std::string Sensor() const { return "unix:" + folder_ + "/sensor.sock"; }
  std::string Devices() const { return "unix:" + folder_ + "/devices.sock"; }

  std::unique_ptr<Program> StartDaemon(const std::string& log) {
    return std::make_unique<Program>(
        "footingd",
        std::vector<std::string>{"--listen", Sensor(), "--source", "stream:" + Devices()},
        folder_ + "/" + log);
  }
  std::unique_ptr<Program> StartStream(std::vector<std::string> words) {
    words.insert(words.end(), {"--to", Devices()});
    return std::make_unique<Program>("footing-stream", words, folder_ + "/stream.log");
  }

  void Take(const v1::Tick& tick) {
    for (const auto& status : tick.status().devices()) status_[status.serial()] = status;
    for (const auto& sample : tick.motion().samples()) motion_.push_back(sample);
    for (const auto& sample : tick.boards().samples()) boards_.push_back(sample);
    for (const auto& sample : tick.nunchuk().samples()) nunchuks_.push_back(sample);
    if (tick.has_features()) features_ = tick.features();
  }

  /// Runs until the condition holds; false after `limit_s`.
  bool RunUntil(const std::function<bool()>& done, double limit_s = 60) {
    const std::int64_t end_ns = clock::MonotonicNs() + static_cast<std::int64_t>(limit_s * 1e9);
    while (!done()) {
      if (clock::MonotonicNs() > end_ns) return false;
      io_.run_for(std::chrono::milliseconds(5));
      io_.restart();
    }
    return true;
  }

  std::size_t CountStates(v1::DeviceState state) const {
    std::size_t count = 0;
    for (const auto& [serial, status] : status_) count += status.state() == state ? 1 : 0;
    return count;
  }
  std::string TextOf(const std::string& log) const {
    std::ifstream file(folder_ + "/" + log);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string folder_;
  boost::asio::io_context io_;
  std::unique_ptr<Program> daemon_;
  std::unique_ptr<transport::Client> client_;
  std::map<std::string, v1::DeviceStatus> status_;
  std::vector<v1::MotionSample> motion_;
  std::vector<v1::BoardSample> boards_;
  std::vector<v1::NunchukSample> nunchuks_;
  v1::FeatureFrame features_;
};

TEST_F(SensorLine, StillHandsReadOneGStampedSimulatedAndAKilledStreamIsLost) {
  const auto stream = StartStream({"user", "--script", "rest", "--interface", "wrist"});
  ASSERT_TRUE(RunUntil([this] { return motion_.size() > 300; }));
  double mean = 0;
  for (const auto& sample : motion_) {
    const auto& force = sample.specific_force_mps2();
    mean += std::hypot(force.x(), force.y(), force.z()) / static_cast<double>(motion_.size());
    ASSERT_TRUE(sample.simulated());
    ASSERT_FALSE(sample.uncalibrated());
    ASSERT_LE(sample.sampled_ns(), sample.received_ns());
    ASSERT_NEAR(force.z(), -kG, 0.5);
  }
  EXPECT_NEAR(mean, kG, 0.1);  // Half a count of z is 0.09.
  ASSERT_TRUE(RunUntil([this] { return CountStates(v1::DEVICE_STATE_LIVE) == 2; }));
  for (const auto& [serial, status] : status_) {
    EXPECT_TRUE(status.simulated());
    EXPECT_EQ(status.calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
    EXPECT_EQ(status.rig(), "main");
  }
  EXPECT_EQ(stream->End(SIGKILL), -1);
  EXPECT_TRUE(RunUntil([this] { return CountStates(v1::DEVICE_STATE_LOST) == 2; }));
  EXPECT_EQ(daemon_->End(SIGTERM), 0);
}

TEST_F(SensorLine, ARunningUserIsHeardAsRunning) {
  const auto stream = StartStream({"user", "--script", "run", "--interface", "wrist"});
  const auto runs = [this] {
    if (features_.rigs_size() != 1 || features_.rigs(0).pairs_size() != 1) return false;
    const auto& rig = features_.rigs(0);
    return rig.pairs(0).phase_valid() && std::abs(rig.pairs(0).phase_rad()) > 2.5 &&
           std::abs(rig.devices(0).frequency_hz() - 3.0) < 0.15;
  };
  EXPECT_TRUE(RunUntil(runs));
  EXPECT_EQ(stream->End(SIGTERM), 0);
}

TEST_F(SensorLine, TheJoystickUsersStickAndButtonArrive) {
  const auto stream = StartStream({"user", "--script", "jump", "--interface", "joystick"});
  const auto pressed = [this] {
    return std::any_of(motion_.begin(), motion_.end(),
                       [](const auto& sample) { return (sample.buttons() & 0x0008) != 0; });
  };
  ASSERT_TRUE(RunUntil(
      [&] { return pressed() && !nunchuks_.empty() && nunchuks_.back().stick_y() > 0.4; }));
  for (const auto& sample : nunchuks_) {
    ASSERT_FALSE(sample.uncalibrated());
    ASSERT_NEAR(sample.stick_x(), 0, 0.02);
    ASSERT_NEAR(sample.specific_force_mps2().z(), -kG, 0.2);
  }
}

TEST_F(SensorLine, AMotionPlusWithANunchukBehindItTellsHowTheHandsIncline) {
  const auto stream = StartStream({"user", "--script", "turn", "--motion-plus", "--nunchuk"});
  double fastest_radps = 0;
  ASSERT_TRUE(RunUntil([&] {
    for (const auto& sample : motion_) {
      if (!sample.has_angular_velocity_radps()) continue;
      const auto& turn = sample.angular_velocity_radps();
      fastest_radps = std::max(fastest_radps, std::abs(turn.y()));
    }
    return fastest_radps > 2 && nunchuks_.size() > 50;  // 20 degrees within 0.15 s.
  }));
  for (const auto& [serial, status] : status_) {
    EXPECT_EQ(status.extension(), v1::EXTENSION_MOTION_PLUS_NUNCHUK) << serial;
    EXPECT_EQ(status.gyroscope_calibration(), v1::CALIBRATION_ORIGIN_DEVICE) << serial;
  }
}

TEST_F(SensorLine, RecordedCornersArriveAsForces) {
  std::ofstream(folder_ + "/corners.csv")
      << "time_s,tl_kg,tr_kg,bl_kg,br_kg\n0,10,20,10,20\n60,10,20,10,20\n";
  const auto stream =
      StartStream({"corners", "--left", folder_ + "/corners.csv", "--seconds", "60"});
  ASSERT_TRUE(RunUntil([this] { return boards_.size() > 100; }));
  const v1::BoardSample& sample = boards_.back();
  EXPECT_NEAR(sample.total_n(), 60 * kG, 0.5);
  EXPECT_NEAR(sample.cop_x_m(), 0.433 / 2 * (40.0 - 20.0) / 60.0, 1e-3);
  EXPECT_NEAR(sample.cop_y_m(), 0, 1e-3);
  EXPECT_TRUE(sample.simulated());
}

TEST_F(SensorLine, GarbageOnTheDeviceSocketHarmsNobody) {
  const auto stream = StartStream({"user", "--script", "rest", "--interface", "wrist"});
  ASSERT_TRUE(RunUntil([this] { return CountStates(v1::DEVICE_STATE_LIVE) == 2; }));
  std::vector<std::string> rubbish = {std::string(5000, '\xff'), std::string("\x05\0\0\0abcde", 9),
                                      std::string("\xff\xff", 2), std::string()};
  std::vector<transport::Socket> half_open;
  for (const std::string& bytes : rubbish) {
    transport::Dial(io_, transport::ParseAddress(Devices()).value(),
                    [&](Result<transport::Socket> socket) {
                      ASSERT_TRUE(socket);
                      boost::system::error_code ignored;
                      boost::asio::write(socket->plain(), boost::asio::buffer(bytes), ignored);
                      half_open.push_back(std::move(socket).value());
                    });
  }
  ASSERT_TRUE(RunUntil([&] { return half_open.size() == rubbish.size(); }));
  const std::size_t before = motion_.size();
  ASSERT_TRUE(RunUntil([&] { return motion_.size() > before + 200; }));
  EXPECT_EQ(CountStates(v1::DEVICE_STATE_LIVE), 2u);
}

TEST_F(SensorLine, AnAddressInUseIsOneLineAndExitCodeOne) {
  ASSERT_TRUE(RunUntil([this] { return client_->state() == transport::LinkState::kLive; }));
  const auto second = StartDaemon("second.log");
  EXPECT_EQ(second->Wait(), 1);
  const std::string text = TextOf("second.log");
  EXPECT_NE(text.find("error: "), std::string::npos) << text;
  EXPECT_NE(text.find("sensor.sock"), std::string::npos) << text;
}

TEST_F(SensorLine, AStreamThatComesFirstWaitsForTheDaemon) {
  ASSERT_TRUE(RunUntil([this] { return client_->state() == transport::LinkState::kLive; }));
  EXPECT_EQ(daemon_->End(SIGTERM), 0);
  const auto stream = StartStream({"user", "--script", "rest", "--interface", "wrist"});
  EXPECT_TRUE(RunUntil(
      [this] { return TextOf("stream.log").find("waiting for footingd") != std::string::npos; }));
  daemon_ = StartDaemon("again.log");
  EXPECT_TRUE(RunUntil([this] { return CountStates(v1::DEVICE_STATE_LIVE) == 2; }));
}

}  // namespace
}  // namespace footing
