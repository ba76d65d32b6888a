#include "clients/camera/calibrate.h"

#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <utility>

#include "clients/camera/lights.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/net/run_folder.h"

namespace footing::camera {
namespace {

constexpr std::chrono::seconds kDevicesWithin(5), kStepWithin(30);

class Calibrating {
 public:
  explicit Calibrating(const CalibrateOptions& options)
      : options_(options),
        signals_(io_, SIGINT, SIGTERM),
        limit_(io_),
        lights_(io_, options.sensor, [this] { OnDevices(); }) {}

  Result<BlinkReport> Run() {
    auto source = OpenFrames(io_, options_.frames, options_.camera,
                             [](const std::string& line) { log::Warning(line); });
    if (!source) return source.error();
    source_ = std::move(source).value();
    signals_.async_wait([this](boost::system::error_code error, int) {
      if (!error) End(Failure("stopped"));
    });
    lights_.Start();
    log::Info("looking for PS Moves in footingd at " + options_.sensor.Text());
    Limit(kDevicesWithin);
    io_.run();
    if (!end_) return end_.error();
    return report_;
  }

 private:
  /// What takes longer does not come any more.
  void Limit(std::chrono::seconds within) {
    limit_.expires_after(within);
    limit_.async_wait([this](boost::system::error_code error) {
      if (!error) End(Late());
    });
  }

  Error Late() const {
    if (calibration_)
      return Failure("no frames came for 30 s: is " + options_.frames.Name() + " sending?");
    if (!lights_.has_list())
      return NoDevice(
          "no footingd: " + lights_.link() +
          transport::RemedyFor(lights_.link(), "start it, or name its address with --sensor"));
    return NoDevice(
        "footingd has no PS Move with the role left_hand, right_hand or head: connect one, then "
        "give it one of them (footing-ctl assign)");
  }

  void OnDevices() {
    if (calibration_ || ended_ || lights_.moves().empty()) return;
    std::vector<double> radii_m;
    for (const stream::DeviceStatus& move : lights_.moves()) {
      for (const BlinkReport::Sphere& other : report_.spheres) {
        if (other.role == move.role)
          return End(UsageError(other.serial + " and " + move.serial + " are both " +
                                stream::Name(move.role) +
                                ": give one another role (footing-ctl assign)"));
      }
      BlinkReport::Sphere sphere{move.role, move.serial, sphere::Target().radius_m, {}};
      for (const frames::HeldSphere& held : options_.camera.spheres)
        if (held.role == move.role) sphere.radius_m = held.target.radius_m;
      devices_.push_back(move.device);
      radii_m.push_back(sphere.radius_m);
      report_.spheres.push_back(std::move(sphere));
    }
    if (devices_.size() > 4) return End(UsageError("more than four PS Moves: switch some off"));
    calibration_.emplace(options_.camera.lens, options_.camera.settings, std::move(radii_m));
    source_->Start(
        [this](const frames::Frame& frame, std::int64_t exposed_ns) { Take(frame, exposed_ns); },
        [this](Result<void> end) {
          End(end ? Result<void>(Failure("the frames ended before the calibration did")) : end);
        });
    Switch();
  }

  /// Sets all lights as the calibration wants them now.
  void Switch() {
    step_ = calibration_->steps();
    Limit(kStepWithin);
    if (const std::string message = calibration_->TakeMessage(); !message.empty())
      log::Info(message);
    unanswered_ = devices_.size();
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      lights_.Set(devices_[i], calibration_->lights()[i], [this, i](Result<void> done) {
        if (!done)
          return End(Failure(report_.spheres[i].serial +
                             ": its light cannot be set: " + done.error().message));
        if (--unanswered_ == 0 && !ended_) calibration_->LightsAreSet(clock::MonotonicNs());
      });
    }
  }

  void Take(const frames::Frame& frame, std::int64_t exposed_ns) {
    if (ended_) return;
    if (const auto checked = CheckSize(frame, options_.camera); !checked)
      return End(checked.error());
    if (const auto taken = calibration_->Take(frame.View(), exposed_ns); !taken)
      return End(taken.error());
    if (calibration_->is_done()) return Finish();
    if (calibration_->steps() != step_) Switch();
  }

  void Finish() {
    for (std::size_t i = 0; i < report_.spheres.size(); ++i)
      report_.spheres[i].calibrated = calibration_->spheres()[i];
    report_.profile = calibration_->profile();
    End({});
  }

  void End(Result<void> end) {
    if (std::exchange(ended_, true)) return;
    end_ = std::move(end);
    source_->Stop();
    lights_.Stop();
    signals_.cancel();
    limit_.cancel();
  }

  const CalibrateOptions& options_;
  boost::asio::io_context io_{1};
  boost::asio::signal_set signals_;
  boost::asio::steady_timer limit_;
  Lights lights_;
  std::unique_ptr<Source> source_;
  std::optional<BlinkCalibration> calibration_;
  std::vector<std::uint32_t> devices_;
  int step_ = 0;
  std::size_t unanswered_ = 0;
  BlinkReport report_;
  Result<void> end_;
  bool ended_ = false;
};

}  // namespace

Result<BlinkReport> Calibrate(const CalibrateOptions& options) {
  return Calibrating(options).Run();
}

}  // namespace footing::camera
