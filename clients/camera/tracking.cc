#include "clients/camera/tracking.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "clients/camera/blink_calibration.h"
#include "clients/camera/light_checks.h"
#include "clients/camera/preview_server.h"
#include "common/base/text.h"
#include "common/camera/find.h"
#include "common/net/device_link.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::camera {
namespace {

constexpr std::size_t kMaxQueuedFrames = 64;  // To footingd.
constexpr std::chrono::milliseconds kLookAtTheFileEvery(500);

/// The time of a file's last change; any constant one where there is no file.
std::filesystem::file_time_type ChangedAt(const std::string& path) {
  std::error_code none;
  const auto at = std::filesystem::last_write_time(path, none);
  return none ? std::filesystem::file_time_type::min() : at;
}

class Tracking {
 public:
  explicit Tracking(const TrackingOptions& options)
      : options_(options),
        X_WC_(options.camera.X_WC),
        changed_at_(ChangedAt(options.camera_path)),
        io_(1),
        look_(io_),
        link_(io_, {.to = options.to,
                    .client_name = "footing-camera",
                    .max_queued_frames = kMaxQueuedFrames,
                    .on_open = [this] { log::Info("sending hands to " + options_.to.Text()); }}),
        finder_(options.camera.lens, options.camera.Targets(), options.camera.settings),
        // Recorded frames do not follow a light.
        checks_(
            options.camera, options.challenge && options.frames.folder.empty(),
            [this](std::uint32_t device, std::uint32_t rgb, LightChecks::Done done) {
              lights_->Set(device, rgb, std::move(done));
            },
            clock::MonotonicNs) {
    report_.found.resize(options.camera.spheres.size());
  }

  Result<TrackingReport> Run() {
    auto source = OpenFrames(io_, options_.frames, options_.camera,
                             [this](const std::string& line) { Alarm(line); });
    if (!source) return source.error();
    source_ = std::move(source).value();
    if (auto opened = OpenPreview(); !opened) return opened.error();
    program_end_.After(options_.seconds, [this] { EndInTime({}); });
    link_.Start();
    const auto& spheres = options_.camera.spheres;
    if (std::any_of(spheres.begin(), spheres.end(), [](const auto& one) { return one.led_rgb; })) {
      lights_.emplace(io_, options_.sensor, [this] { checks_.TakeMoves(lights_->moves()); });
      lights_->Start();
    }
    LookAtTheFile();
    source_->Start(
        [this](const frames::Frame& frame, std::int64_t exposed_ns) { Take(frame, exposed_ns); },
        [this](Result<void> end) { EndInTime(std::move(end)); });
    io_.run();
    if (!end_) return end_.error();
    report_.sent = link_.sent();
    report_.challenges_passed = checks_.passed();
    report_.lights_refused = checks_.refusals();
    report_.cost_p50_ms = text::Quantile(cost_ms_, 0.5);
    report_.cost_p99_ms = text::Quantile(cost_ms_, 0.99);
    return report_;
  }

 private:
  static constexpr std::size_t kMostCosts = 1 << 16;
  static constexpr std::size_t kMostAlarms = 32;

  void Alarm(const std::string& line) {
    log::Warning(line);
    if (report_.alarms.size() < kMostAlarms) report_.alarms.push_back(line);
  }

  Result<void> OpenPreview() {
    if (!options_.preview) return {};
    auto opened = PreviewServer::Open(*options_.preview, options_.camera);
    if (!opened && options_.needs_preview) return opened.error();
    if (opened) {
      preview_ = std::move(opened).value();
    } else {
      log::Warning("no preview: " + opened.error().message);
    }
    return {};
  }

  /// Takes a new pose from the camera file, as a calibration writes it.
  void LookAtTheFile() {
    if (options_.camera_path.empty() || ended_) return;
    look_.After(kLookAtTheFileEvery, [this] {
      const auto at = ChangedAt(options_.camera_path);
      if (std::exchange(changed_at_, at) != at) {
        const auto camera = frames::ReadCameraFile(options_.camera_path);
        if (camera) {
          X_WC_ = camera->X_WC;
          log::Info("took the camera's pose from " + options_.camera_path);
        } else {
          log::Warning(camera.error().message + "; the camera's old pose stays in use");
        }
      }
      LookAtTheFile();
    });
  }

  void Take(const frames::Frame& frame, std::int64_t exposed_ns) {
    if (const auto checked = CheckSize(frame, options_.camera); !checked)
      return End(checked.error());
    const std::int64_t began_ns = clock::ThreadCpuNs();
    auto found = finder_.Find(frame.View());
    if (cost_ms_.size() < kMostCosts)
      cost_ms_.push_back(1e-6 * static_cast<double>(clock::ThreadCpuNs() - began_ns));
    SeenFrame* const shown =
        preview_ && preview_->Wants(clock::MonotonicNs()) ? &preview_->Next() : nullptr;
    if (shown != nullptr) shown->found = found;
    checks_.TakeFrame(exposed_ns, finder_, found);
    if (shown != nullptr) ShowPreview(frame, exposed_ns, *shown);
    for (stream::HandFrame& hand :
         ToHandFrames(options_.camera, X_WC_, found, exposed_ns, clock::MonotonicNs())) {
      hand.simulated = options_.simulated;
      link_.Send(hand);
    }
    ++report_.frames;
    for (std::size_t i = 0; i < found.size(); ++i) {
      report_.found[i] += found[i] ? 1 : 0;
      if (!found[i] || !found[i]->is_saturated) continue;
      if (report_.saturated++ == 0)
        log::Warning(
            "a sphere is brighter than the camera can see: lower the exposure, or depth "
            "is wrong by centimetres");
    }
  }

  void ShowPreview(const frames::Frame& frame, std::int64_t exposed_ns, SeenFrame& shown) {
    shown.number = report_.frames + 1;
    shown.exposed_ns = exposed_ns;
    shown.frame = frame;
    shown.verdicts = checks_.Verdicts();
    shown.has_pose = X_WC_.has_value();
    shown.simulated = options_.simulated;
    preview_->Show(clock::MonotonicNs());
  }

  /// Not by a signal: everything that was to be done is done.
  void EndInTime(Result<void> end) {
    if (!link_.was_open()) report_.sent_on = link_.NeverOpen();
    End(std::move(end));
  }

  void End(Result<void> end) {
    if (std::exchange(ended_, true)) return;
    end_ = std::move(end);
    source_->Stop();
    link_.Stop("footing-camera ends");
    if (lights_) lights_->Stop();
    program_end_.cancel();
    look_.cancel();
  }

  const TrackingOptions& options_;
  std::optional<Eigen::Isometry3d> X_WC_;
  std::filesystem::file_time_type changed_at_;
  boost::asio::io_context io_;
  service_manager::ProgramEnd program_end_{io_, [this] { End({}); }};
  timer::Timer look_;
  device_link::DeviceLink link_;
  sphere::Finder finder_;
  LightChecks checks_;
  std::optional<Lights> lights_;  // Its end answers what checks_ still waits for.
  std::unique_ptr<Source> source_;
  std::unique_ptr<PreviewServer> preview_;
  TrackingReport report_;
  std::vector<double> cost_ms_;
  Result<void> end_;
  bool ended_ = false;
};

}  // namespace

Result<TrackingReport> Track(const TrackingOptions& options) { return Tracking(options).Run(); }

namespace {

constexpr double kFarthestM = 10, kLargestSdM = 1;  // Limits of a hand frame.
constexpr std::int64_t kOldestNs = 1'000'000'000;

stream::TrackedPoint ToPoint(const Eigen::Isometry3d& X_WC, const sphere::Estimate& estimate) {
  stream::TrackedPoint point;
  const Eigen::Matrix3d covariance =
      X_WC.linear() * estimate.covariance_m2 * X_WC.linear().transpose();
  point.position_m = X_WC * estimate.p_C_m;
  point.sd_m = covariance.diagonal().cwiseSqrt();
  if (!(point.position_m.norm() <= kFarthestM) || !point.sd_m.allFinite() ||
      point.sd_m.maxCoeff() > kLargestSdM)
    return stream::TrackedPoint();
  point.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
  point.confidence = estimate.confidence;
  point.saturated = estimate.is_saturated;
  point.occluded = estimate.is_occluded;
  return point;
}

}  // namespace

std::vector<stream::HandFrame> ToHandFrames(
    const frames::CameraFile& camera, const std::optional<Eigen::Isometry3d>& calibrated_X_WC,
    const std::vector<std::optional<sphere::Estimate>>& found, std::int64_t exposed_ns,
    std::int64_t now_ns) {
  const Eigen::Isometry3d X_WC = calibrated_X_WC.value_or(Eigen::Isometry3d::Identity());
  std::vector<stream::HandFrame> frames;
  for (std::size_t i = 0; i < found.size(); ++i) {
    stream::HandFrame frame;
    frame.tracker = "camera";
    frame.tracker_pose =
        stream::TrackerPose{X_WC.translation(), Eigen::Quaterniond(X_WC.rotation())};
    stream::TrackedPoint point = found[i] ? ToPoint(X_WC, *found[i]) : stream::TrackedPoint();
    if (camera.spheres[i].role == stream::DeviceRole::kHead)
      point.joint = stream::BodyJoint::kHead;
    else
      point.role = camera.spheres[i].role;
    frame.points.push_back(point);
    const double row_s = found[i] ? camera.RowTime(found[i]->centre_px.y()) : 0;
    const auto row_ns = static_cast<std::int64_t>(std::llround(1e9 * row_s));
    frame.age_ns = std::clamp<std::int64_t>(now_ns - exposed_ns - row_ns, 0, kOldestNs);
    frame.sent_ns = now_ns;
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace footing::camera
