#include "clients/view/scene/sound.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/view/scene/model.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kLongestGapS = 0.25;  // A longer one is a seek or a server that was away.
/// A run's flights last up to 0.3 s at the usual speeds, a jump's 0.5 s.
constexpr double kWingsFromS = 0.33, kLandingFromS = 0.35;
/// A leg that is put down under a body that stays up is lighter than the body.
constexpr double kLegShare = 0.5;
constexpr double kLoudMps = 2;  // 63 % of the peak.
constexpr double kQuietest = 0.08;
constexpr double kUsualDistanceM = 5;

/// How a kind sounds: a burst of noise below a frequency, which dies away, over a thump.
struct Timbre {
  double duration_s, noise_decay_s;
  double cutoff_hz, cutoff_hz_per_mps;  ///< Harder impacts are brighter.
  double thump, thump_hz, thump_decay_s;
};
constexpr Timbre kStepTimbre{0.14, 0.022, 500, 700, 0.6, 95, 0.030};
constexpr Timbre kLandingTimbre{0.32, 0.045, 400, 450, 1.2, 62, 0.065};

constexpr double kWingsS = 0.34, kWingsLowHz = 250, kWingsHighHz = 1300;
constexpr double kAttackS = 0.0015, kEndS = 0.01;

/// White noise in [-1, 1] (Marsaglia 2003, "Xorshift RNGs").
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : state_(2463534242u ^ (seed * 2654435761u)) {
    if (state_ == 0) state_ = 1;
  }
  double Next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return static_cast<double>(state_) / 2147483648.0 - 1;
  }

 private:
  std::uint32_t state_;
};

/// A first-order low pass.
class LowPass {
 public:
  LowPass(double cutoff_hz, int rate_hz) : share_(1 - std::exp(-2 * kPi * cutoff_hz / rate_hz)) {}
  double Next(double x) { return y_ += share_ * (x - y_); }

 private:
  double share_, y_ = 0;
};

std::vector<double> Impact(const Timbre& timbre, const Sound& sound, int rate_hz) {
  Noise noise(sound.seed);
  LowPass low(timbre.cutoff_hz + timbre.cutoff_hz_per_mps * sound.impact_mps, rate_hz);
  std::vector<double> samples(static_cast<std::size_t>(timbre.duration_s * rate_hz));
  const double hardness = std::min(1.0, sound.impact_mps / kLoudMps);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t_s = static_cast<double>(i) / rate_hz;
    const double thump = timbre.thump * hardness * std::sin(2 * kPi * timbre.thump_hz * t_s) *
                         std::exp(-t_s / timbre.thump_decay_s);
    samples[i] = low.Next(noise.Next()) * std::exp(-t_s / timbre.noise_decay_s) + thump;
  }
  return samples;
}

/// Air that two beats move: noise of a band, which swells and fades twice.
std::vector<double> Beats(const Sound& sound, int rate_hz) {
  Noise noise(sound.seed);
  LowPass high(kWingsHighHz, rate_hz), low(kWingsLowHz, rate_hz);
  std::vector<double> samples(static_cast<std::size_t>(kWingsS * rate_hz));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(samples.size());
    const double passed = high.Next(noise.Next());
    const double swell = std::sin(2 * kPi * share);
    samples[i] = (passed - low.Next(passed)) * swell * swell * (1 - 0.6 * share);
  }
  return samples;
}

std::vector<double> Shaped(const Sound& sound, int rate_hz) {
  switch (sound.kind) {
    case SoundKind::kStep:
      return Impact(kStepTimbre, sound, rate_hz);
    case SoundKind::kLanding:
      return Impact(kLandingTimbre, sound, rate_hz);
    case SoundKind::kWings:
      return Beats(sound, rate_hz);
  }
  return {};
}

/// Without a click at either end.
void FadeEnds(std::vector<double>& samples, int rate_hz) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double from_start_s = static_cast<double>(i) / rate_hz;
    const double to_end_s = static_cast<double>(samples.size() - 1 - i) / rate_hz;
    samples[i] *= std::min({1.0, from_start_s / kAttackS, to_end_s / kEndS});
  }
}

/// Where a point is seen, from the left edge of the picture to the right one.
double PanOf(const Camera& camera, double aspect, const Eigen::Vector3d& p_m) {
  const Eigen::Vector4f clip =
      camera.Projection(aspect) * camera.View() * Eigen::Vector4f(p_m.cast<float>().homogeneous());
  if (clip.w() <= 0) return 0;
  return std::clamp(static_cast<double>(clip.x() / clip.w()), -1.0, 1.0);
}

bool AnyTouches(const std::vector<stream::Contact>& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const stream::Contact& contact) { return contact.touching; });
}

}  // namespace

double GainOfImpact(double impact_mps) {
  return kQuietest + (1 - kQuietest) * (1 - std::exp(-std::max(0.0, impact_mps) / kLoudMps));
}

std::vector<float> Synthesized(const Sound& sound, int rate_hz) {
  std::vector<double> samples = Shaped(sound, rate_hz);
  FadeEnds(samples, rate_hz);
  double peak = 0;
  for (const double sample : samples) peak = std::max(peak, std::abs(sample));
  const double scale = peak > 0 ? std::clamp(sound.gain, 0.0, 1.0) / peak : 0;
  std::vector<float> scaled;
  scaled.reserve(samples.size());
  for (const double sample : samples) scaled.push_back(static_cast<float>(scale * sample));
  return scaled;
}

void SoundFinder::Listen(std::uint32_t character, const Heard& before, Heard& now,
                         const Camera& camera, double aspect, std::vector<Sound>& sounds) {
  const double passed_s = now.time_s - before.time_s;
  const auto add = [&](SoundKind kind, double impact_mps, const Eigen::Vector3d& p_m, int foot) {
    const double near = kUsualDistanceM / std::max(kUsualDistanceM, (p_m - camera.eye_m).norm());
    sounds.push_back({kind, impact_mps, near * GainOfImpact(impact_mps), PanOf(camera, aspect, p_m),
                      count_++, character, foot});
  };
  SoundKind kind = before.airborne_s >= kLandingFromS ? SoundKind::kLanding : SoundKind::kStep;
  for (std::size_t i = 0; i < std::min(now.contacts.size(), before.contacts.size()); ++i) {
    const stream::Contact& foot = now.contacts[i];
    if (!foot.touching || before.contacts[i].touching) continue;
    const double foot_mps = (before.contacts[i].position_m.z() - foot.position_m.z()) / passed_s;
    add(kind, std::max({0.0, before.descent_mps, kLegShare * foot_mps}), foot.position_m,
        static_cast<int>(i));
    kind = SoundKind::kStep;
  }
  if (AnyTouches(now.contacts) || now.contacts.empty()) return;
  now.airborne_s = before.airborne_s + passed_s;
  now.wings = now.airborne_s >= kWingsFromS;
  if (now.wings && !before.wings) add(SoundKind::kWings, kLoudMps / 4, now.com_m, -1);
}

std::vector<Sound> SoundFinder::Advance(const WorldFrame& frame, const Camera& camera,
                                        double aspect) {
  std::vector<Sound> sounds;
  std::map<std::uint32_t, Heard> heard;
  for (const CharacterPose& pose : frame.characters) {
    if (!pose.valid) continue;
    Heard now;
    now.time_s = frame.time_s;
    now.com_m = pose.com_m;
    now.descent_mps = -pose.com_velocity_mps.z();
    now.contacts = pose.contacts;
    const auto before = heard_.find(pose.character);
    if (before != heard_.end()) {
      const double passed_s = now.time_s - before->second.time_s;
      const bool goes_on = passed_s > 0 && passed_s <= kLongestGapS &&
                           (now.com_m - before->second.com_m).norm() < kPutBackM;
      if (passed_s == 0) now = before->second;
      if (goes_on) Listen(pose.character, before->second, now, camera, aspect, sounds);
    }
    heard.emplace(pose.character, std::move(now));
  }
  heard_ = std::move(heard);
  return sounds;
}

}  // namespace footing::scene
