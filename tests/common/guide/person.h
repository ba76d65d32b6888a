#pragma once

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/guide/set_up.h"

namespace footing::guide {

inline constexpr std::int64_t kSetUpSecondNs = 1'000'000'000;
inline constexpr double kWeightN = 70 * 9.80665;

/// Somebody with two boards and two shin devices who does what the prompts say, and a footingd that
/// answers. Boards 1 and 2 lie left and right; devices 3 and 4 are on the left and right shin.
class Person {
 public:
  Person() {
    for (std::uint32_t device = 1; device <= 4; ++device) {
      stream::DeviceStatus status;
      status.device = device;
      status.serial = "serial-" + std::to_string(device);
      status.kind = device <= 2 ? stream::DeviceKind::kBalanceBoard : stream::DeviceKind::kWiimote;
      status.state = stream::DeviceState::kLive;
      status.rig = "main";
      status.calibration = stream::CalibrationOrigin::kDevice;
      status.report_rate_hz = 90;
      devices.push_back(status);
    }
    SetRoles({stream::DeviceRole::kLeftBoard, stream::DeviceRole::kRightBoard,
              stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg});
  }

  void SetRoles(const std::vector<stream::DeviceRole>& roles) {
    for (std::size_t i = 0; i < roles.size(); ++i) devices[i].role = roles[i];
  }

  /// Runs a set-up to its end, at most two minutes of its own time.
  std::vector<stream::SetupItem> Do(std::vector<Item> items,
                                    std::vector<stream::DeviceRole> body_roles = {}) {
    SetUpOptions options;
    options.patience_s = 20;
    options.body_roles = std::move(body_roles);
    SetUp set_up(options, std::move(items));
    for (int i = 0; i < 20 * 120; ++i) {
      Live();
      Situation now;
      now.now_ns = now_ns_;
      now.recent = &recent_;
      now.setup = &setup;
      now.adapters = {"hci0"};
      now.answers = std::move(answers_);
      answers_.clear();
      const Progress progress = set_up.Advance(now);
      Hear(progress.prompt);
      if (!progress.prompt.empty()) gestures.insert({progress.gesture, progress.role});
      for (const Action& action : progress.actions) Serve(action);
      if (progress.finished) return set_up.results();
    }
    ADD_FAILURE() << "the set-up did not end; it asked: " << heard_;
    return set_up.results();
  }

  std::vector<stream::DeviceStatus> devices;
  double left_yaw_rad = -kPi / 2;  ///< How board 1 lies in truth.
  double right_yaw_rad = kPi / 2;
  bool deaf = false;        ///< Never does anything.
  bool clumsy = false;      ///< Shakes both shins at once.
  double mounting_deg = 4;  ///< Angle that footingd finds.
  std::vector<stream::RigSetup> setup;
  std::set<std::string> prompts;
  std::set<std::pair<stream::Gesture, stream::DeviceRole>> gestures;

 private:
  void Hear(const std::string& whole) {
    prompts.insert(whole);
    const std::string prompt = whole.substr(0, whole.find(" (Again"));
    if (prompt == heard_ || prompt.empty()) return;
    heard_ = prompt;
    heard_ns_ = now_ns_;
  }

  bool Asked(const char* text) const { return !deaf && heard_.find(text) != std::string::npos; }

  /// A twentieth of a second of samples.
  void Live() {
    recent_.SetDevices(devices);
    double left = 0;
    double right = 0;
    double lean_m = 0;
    double shake[2] = {0.1, 0.1};
    const double s = NanosecondsToSeconds(now_ns_ - heard_ns_);
    if (Asked("left board")) left = 1;
    if (Asked("right board")) right = 1;
    if (Asked("Stand upright") || Asked("one foot on each") || Asked("Lean")) left = right = 0.5;
    if (Asked("Lean")) lean_m = 0.05;
    if (Asked("Shake the left")) shake[0] = 12;
    if (Asked("Shake the right")) shake[1] = 12;
    if (clumsy && Asked("Shake")) shake[0] = shake[1] = 12;
    if (Asked("three steps") && s < 2.5) shake[0] = shake[1] = 8;
    for (int i = 0; i < 5; ++i) {
      now_ns_ += kSetUpSecondNs / 100;
      Put(1, left, left_yaw_rad, lean_m);
      Put(2, right, right_yaw_rad, lean_m);
      for (std::uint32_t j = 0; j < 2; ++j) {
        stream::MotionSample sample;
        sample.device = 3 + j;
        sample.received_ns = now_ns_;
        const double phase = 2 * kPi * 5 * NanosecondsToSeconds(now_ns_ % kSetUpSecondNs);
        sample.specific_force_mps2 = {shake[j] * std::sqrt(2) * std::sin(phase), 0, -9.81};
        recent_.Add(sample);
      }
    }
  }

  void Put(std::uint32_t device, double share, double yaw_rad, double forward_m) {
    stream::BoardSample sample;
    sample.device = device;
    sample.received_ns = now_ns_;
    sample.total_n = share * kWeightN + 1;
    sample.cop_valid = share > 0.1;
    if (sample.cop_valid) {  // Forward in the plate's frame: front and right, by its yaw.
      sample.cop_y_m = forward_m * std::cos(yaw_rad);
      sample.cop_x_m = forward_m * std::sin(yaw_rad);
    }
    recent_.Add(sample);
  }

  void Serve(const Action& action) {
    Answer answer;
    answer.key = action.key;
    answer.ok = true;
    if (action.kind == Action::Kind::kTare) answer.residual = 0.7;
    if (action.kind == Action::Kind::kSolveMounting) {
      answer.residual = mounting_deg;
      EXPECT_GE(action.still_to_ns - action.still_from_ns, 2 * kSetUpSecondNs);
      EXPECT_GT(action.steps_to_ns, action.steps_from_ns + 2 * kSetUpSecondNs);
    }
    if (action.kind == Action::Kind::kAssign) {  // A role that is taken is swapped.
      stream::DeviceStatus* one = nullptr;
      stream::DeviceStatus* other = nullptr;
      for (auto& device : devices) {
        if (device.serial == action.serial) one = &device;
        if (device.role == action.role) other = &device;
      }
      ASSERT_NE(one, nullptr);
      if (other != nullptr) std::swap(one->role, other->role);
      one->role = action.role;
    }
    answers_.push_back(answer);
  }

  std::int64_t now_ns_ = 100 * kSetUpSecondNs;
  std::int64_t heard_ns_ = 0;
  std::string heard_;
  Recent recent_;
  std::vector<Answer> answers_;
};

}  // namespace footing::guide
