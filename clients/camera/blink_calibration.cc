#include "clients/camera/blink_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "clients/camera/light_checks.h"
#include "clients/camera/video_port.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"
#include "common/net/address.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/wire/wire.h"

namespace footing::camera {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr int kMeanFrames = 6;
constexpr std::size_t kEstimates = 48;  // Estimates of each sphere.
constexpr int kMostFrames = 120;        // Frames within which they must be found.
constexpr int kMostFailures = 3;
constexpr double kMostClipped = 0.02, kDimmer = 0.7, kDarkest = 0.1;
constexpr double kSameColour = 0.15;  // Share of its brightness, from blink to blink.
constexpr double kNearestHeldM = 0.35, kFarthestHeldM = 1.6;
/// One place in the picture is like eight others at most: the pixels around it are the same.
constexpr double kIndependent = 8;

/// Hues that stay apart on any sensor: 30 degrees and more.
constexpr std::array<std::uint32_t, 4> kHues = {0xff00c8, 0x00ffb4, 0xffb000, 0x0040ff};

std::uint32_t Dimmed(std::uint32_t rgb, double level) {
  std::uint32_t dimmed = 0;
  for (const int shift : {16, 8, 0})
    dimmed |= static_cast<std::uint32_t>(std::lround(level * ((rgb >> shift) & 0xff))) << shift;
  return dimmed;
}

double Scatter(const std::vector<sphere::Estimate>& estimates, double mean,
               double sphere::Estimate::*value) {
  double square = 0;
  for (const auto& one : estimates) square += (one.*value - mean) * (one.*value - mean);
  return std::sqrt(square / static_cast<double>(estimates.size()));
}

}  // namespace

BlinkCalibration::BlinkCalibration(const sphere::Lens& lens, const sphere::Settings& settings,
                                   std::vector<double> radii_m)
    : lens_(lens), loose_(settings), radii_m_(std::move(radii_m)) {
  FOOTING_CHECK(!radii_m_.empty() && radii_m_.size() <= kHues.size());
  loose_.profile = {1.2, 0.4, 0.2, 0.3};
  spheres_.resize(radii_m_.size());
  estimates_.resize(radii_m_.size());
  message_ = "Hold the controllers 0.5 to 1.2 m from the camera, and keep still.";
  Begin(Step::kDark);
}

void BlinkCalibration::Begin(Step step) {
  step_ = step;
  ++steps_;
  frames_ = 0;
  settled_ns_ = kNever;
  lights_.assign(radii_m_.size(), 0);
  if (step == Step::kLit) {
    spheres_[at_].led_rgb = Dimmed(kHues[at_], level_);
    lights_[at_] = spheres_[at_].led_rgb;
    lit_.Clear();
  } else if (step == Step::kDark) {
    dark_.Clear();
  } else {
    for (std::size_t i = 0; i < spheres_.size(); ++i) lights_[i] = spheres_[i].led_rgb;
  }
}

void BlinkCalibration::LightsAreSet(std::int64_t now_ns) { settled_ns_ = now_ns + kLightDelayNs; }

std::string BlinkCalibration::TakeMessage() { return std::exchange(message_, {}); }

std::string BlinkCalibration::Which() const {
  return "controller " + std::to_string(at_ + 1) + ": ";
}

Result<void> BlinkCalibration::Again(const std::string& problem) {
  if (++failures_ >= kMostFailures) return InvalidData(Which() + problem);
  message_ = Which() + problem;
  blinks_ = 0;
  Begin(Step::kDark);
  return {};
}

Result<void> BlinkCalibration::Take(const sphere::Image& image, std::int64_t exposed_ns) {
  if (step_ == Step::kDone || exposed_ns < settled_ns_) return {};
  ++frames_;
  if (step_ == Step::kAllLit) {
    const auto found = finder_[0].Find(image);
    bool enough = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] && !found[i]->is_occluded && !found[i]->is_saturated)
        estimates_[i].push_back(*found[i]);
      enough = enough && estimates_[i].size() >= kEstimates;
    }
    return enough || frames_ >= kMostFrames ? EndAllLit() : Result<void>();
  }
  sphere::MeanImage& mean = step_ == Step::kDark ? dark_ : lit_;
  mean.Add(image);
  if (mean.count() < kMeanFrames) return {};
  if (step_ == Step::kLit) return EndLit();
  Begin(Step::kLit);
  return {};
}

Result<void> BlinkCalibration::EndLit() {
  const auto blink = sphere::FindBlink(dark_.View(), lit_.View());
  if (!blink) return Again(blink.error().message);
  if (blink->clipped_share > kMostClipped) {
    level_ *= kDimmer;
    if (level_ < kDarkest)
      return InvalidData(Which() + "its sphere is brighter than the camera can see, even when " +
                         "dimmed: lower the exposure");
    blinks_ = 0;
    Begin(Step::kLit);
    return {};
  }
  CalibratedSphere& sphere = spheres_[at_];
  if (++blinks_ == 1) {
    sphere.blink = *blink;
    Begin(Step::kDark);
    return {};
  }
  const double moved_px = (blink->centre_px - sphere.blink.centre_px).norm();
  const double changed = (blink->colour_dn - sphere.blink.colour_dn).norm();
  if (moved_px > sphere.blink.radius_px || changed > kSameColour * sphere.blink.colour_dn.norm())
    return Again("it was elsewhere, or looked different, when it blinked again: keep still");
  sphere.blink = *blink;
  if (blink->colour_dn.maxCoeff() - blink->colour_dn.minCoeff() < 20)
    return InvalidData(Which() +
                       "its light has no hue: raise the exposure, or switch other lights off");
  blinks_ = failures_ = 0;
  level_ = 1;
  if (++at_ < spheres_.size()) {
    Begin(Step::kDark);
    return {};
  }
  std::vector<sphere::Target> targets;
  for (std::size_t i = 0; i < spheres_.size(); ++i)
    targets.push_back({spheres_[i].blink.colour_dn, radii_m_[i]});
  finder_.assign(1, sphere::Finder(lens_, std::move(targets), loose_));
  message_ = "Move the controllers slowly, about a hand's width.";
  Begin(Step::kAllLit);
  return {};
}

Result<void> BlinkCalibration::EndAllLit() {
  std::vector<sphere::Estimate> all;
  for (at_ = 0; at_ < spheres_.size(); ++at_) {
    CalibratedSphere& sphere = spheres_[at_];
    sphere.found = static_cast<int>(estimates_[at_].size());
    if (estimates_[at_].size() < kEstimates / 2)
      return InvalidData(Which() + "its whole sphere was seen in " + std::to_string(sphere.found) +
                         " of " + std::to_string(frames_) +
                         " frames only: hold it in view, with nothing in front");
    for (const auto& one : estimates_[at_]) sphere.distance_m += one.p_C_m.norm() / sphere.found;
    if (sphere.distance_m < kNearestHeldM || sphere.distance_m > kFarthestHeldM) {
      const auto centimetres = std::to_string(std::lround(100 * sphere.distance_m));
      return InvalidData(Which() + "it is " + centimetres +
                         " cm from the camera: hold it 50 to 120 cm away");
    }
    all.insert(all.end(), estimates_[at_].begin(), estimates_[at_].end());
  }
  profile_ = *sphere::Calibrate(all);
  const double share = 1 / std::sqrt(kIndependent);
  profile_.blur_sd_px = std::max(
      profile_.blur_sd_px, share * Scatter(all, profile_.blur_px, &sphere::Estimate::blur_px));
  profile_.limb_sd =
      std::max(profile_.limb_sd, share * Scatter(all, profile_.limb, &sphere::Estimate::limb));
  step_ = Step::kDone;
  return {};
}

namespace {

constexpr double kDevicesWithinS = 5, kStepWithinS = 30;

class Calibrating {
 public:
  explicit Calibrating(const CalibrateOptions& options)
      : options_(options),
        program_end_(io_, [this] { End(Failure("stopped")); }),
        lights_(io_, options.sensor, [this] { OnDevices(); }) {}

  Result<BlinkReport> Run() {
    auto source = OpenFrames(io_, options_.frames, options_.camera,
                             [](const std::string& line) { log::Warning(line); });
    if (!source) return source.error();
    source_ = std::move(source).value();
    lights_.Start();
    log::Info("looking for PS Moves in footingd at " + options_.sensor.Text());
    Limit(kDevicesWithinS);
    io_.run();
    if (!end_) return end_.error();
    return report_;
  }

 private:
  /// Ends the calibration with Late() after `within_s`.
  void Limit(double within_s) {
    program_end_.After(within_s, [this] { End(Late()); });
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
    Limit(kStepWithinS);
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
    program_end_.cancel();
  }

  const CalibrateOptions& options_;
  boost::asio::io_context io_{1};
  service_manager::ProgramEnd program_end_;
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

namespace {

struct CalibrateArguments {
  CommandLine line;
  std::string sensor;
};

double Rounded(double value, double step) { return std::round(value / step) * step; }

nlohmann::ordered_json ToJson(const BlinkReport& report) {
  nlohmann::ordered_json spheres = nlohmann::ordered_json::array();
  for (const BlinkReport::Sphere& one : report.spheres) {
    const auto& blink = one.calibrated.blink;
    const Eigen::Vector3d& c = blink.colour_dn;
    spheres.push_back(
        {{"role", stream::Name(one.role)},
         {"serial", one.serial},
         {"led", frames::ColourText(one.calibrated.led_rgb)},
         {"colour_dn", {Rounded(c.x(), 0.1), Rounded(c.y(), 0.1), Rounded(c.z(), 0.1)}},
         {"distance_m", one.calibrated.distance_m},
         {"found", one.calibrated.found}});
  }
  return {{"spheres", spheres},
          {"blur_px", report.profile.blur_px},
          {"blur_sd_px", report.profile.blur_sd_px},
          {"limb", report.profile.limb},
          {"limb_sd", report.profile.limb_sd}};
}

Result<BlinkReport> CalibrateAndStore(const CalibrateArguments& arguments) {
  if (const auto checked = Check(arguments.line); !checked) return checked.error();
  auto camera = frames::ReadUncalibratedCamera(arguments.line.camera_file);
  if (!camera) return camera.error();
  ApplyExposure(arguments.line, *camera);
  const auto sensor = transport::AddressOrDefault(arguments.sensor, "sensor");
  if (!sensor) return sensor.error();
  auto report = Calibrate({*camera, arguments.line.frames, *sensor});
  if (!report) return report;
  frames::CameraFile calibrated = *camera;
  calibrated.settings.profile = report->profile;
  calibrated.spheres.clear();
  for (const BlinkReport::Sphere& one : report->spheres) {
    calibrated.spheres.push_back(
        {one.role, {one.calibrated.blink.colour_dn, one.radius_m}, one.calibrated.led_rgb});
  }
  const auto stored = frames::StoreSpheres(arguments.line.camera_file, calibrated);
  if (!stored) return stored.error();
  log::Info("stored what the spheres look like in " + arguments.line.camera_file);
  return report;
}

int RunCalibrate(const CalibrateArguments& arguments) {
  log::Start("footing-camera", arguments.line.quiet);
  const auto report = CalibrateAndStore(arguments);
  if (!report) return cli::Report(report.error());
  const nlohmann::ordered_json object = ToJson(*report);
  if (arguments.line.json) {
    std::cout << object << std::endl;
    return 0;
  }
  for (const auto& sphere : object["spheres"])
    std::cout << std::string(sphere["role"]) << ": light " << std::string(sphere["led"])
              << ", seen as " << sphere["colour_dn"] << "\n";
  std::cout << "blur: " << object["blur_px"] << " px\nlimb darkening: " << object["limb"] << "\n";
  return 0;
}

}  // namespace

void AddCalibrateCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "calibrate",
      "Find the spheres of the PS Moves by their lights, and store what they look like");
  const auto arguments = std::make_shared<CalibrateArguments>();
  AddCommandLine(*command, arguments->line);
  command->add_option("--sensor", arguments->sensor,
                      "Address of footingd, unix:PATH or tcp:HOST:PORT");
  command->callback([arguments, &exit_code] { exit_code = RunCalibrate(*arguments); });
}

namespace {

constexpr std::uint32_t kAnswerWithinMs = 3000;

transport::ClientOptions OptionsFor(const transport::Address& address) {
  transport::ClientOptions options;
  options.address = address;
  options.client_name = "footing-camera";
  options.role = v1::ROLE_CONTROL;
  options.channels = {"status"};
  options.max_hz = 10;
  return options;
}

}  // namespace

Lights::Lights(boost::asio::io_context& io, const transport::Address& address,
               std::function<void()> on_devices)
    : on_devices_(std::move(on_devices)),
      client_(io, OptionsFor(address),
              {.on_welcome = [](const v1::Welcome&) {},
               .on_tick = [this](const v1::Tick& tick) { OnTick(tick); },
               .on_gap = [](const v1::Gap&) {},
               .on_state = [this](transport::LinkState, const std::string& why) { link_ = why; }}) {
}

void Lights::OnTick(const v1::Tick& tick) {
  if (!tick.has_status()) return;
  moves_.clear();
  for (const v1::DeviceStatus& one : tick.status().devices()) {
    stream::DeviceStatus device = wire::FromProto(one);
    if (device.kind == stream::DeviceKind::kPsMove && device.state != stream::DeviceState::kLost &&
        frames::CanHoldSphere(device.role))
      moves_.push_back(std::move(device));
  }
  std::stable_sort(moves_.begin(), moves_.end(),
                   [](const auto& a, const auto& b) { return a.role < b.role; });
  has_list_ = true;
  on_devices_();
}

void Lights::Set(std::uint32_t device, std::uint32_t rgb, std::function<void(Result<void>)> done) {
  v1::Command command;
  command.set_deadline_ms(kAnswerWithinMs);
  command.mutable_set_sphere()->set_device(device);
  command.mutable_set_sphere()->set_rgb(rgb);
  client_.Send(std::move(command), [done = std::move(done)](const v1::CommandResult& result) {
    done(result.ok() ? Result<void>() : Failure(result.message()));
  });
}

}  // namespace footing::camera
