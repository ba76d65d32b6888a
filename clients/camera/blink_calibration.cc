#include "clients/camera/blink_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "clients/camera/light_delay.h"

namespace footing::camera {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr int kMeanFrames = 6;
constexpr std::size_t kEstimates = 48;  // Of each sphere.
constexpr int kMostFrames = 120;        // In which they must be had.
constexpr int kMostFailures = 3;
constexpr double kMostClipped = 0.02, kDimmer = 0.7, kDarkest = 0.1;
constexpr double kSameColour = 0.15;  // Of its brightness, from blink to blink.
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

}  // namespace footing::camera
