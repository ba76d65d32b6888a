#include "clients/camera/light_checks.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/runtime/log.h"

namespace footing::camera {
namespace {

constexpr double kLeastConfidence = 0.05;        // Estimates below this are not sent as hands.
constexpr int kSeenFrames = 2;                   // In succession, before the light goes out for it.
constexpr int kDarkFrames = 3, kBackFrames = 2;  // Without it, in succession; with it.
// A slow radio is not a lamp: a light may follow this much later than it should.
constexpr std::int64_t kStaysLitNs = 1'000'000'000, kStaysDarkNs = 1'500'000'000;
constexpr int kMostRefusals = 8;  // In one challenge.
constexpr std::int64_t kSwitchedWithinNs = 5'000'000'000;
constexpr std::int64_t kAgainAfterNs = 2'000'000'000;
constexpr std::int64_t kRefusedForNs = 60'000'000'000;  // The camera or the lamp may be moved.
constexpr std::int64_t kTrustedForNs = 1'000'000'000;
// Where a hand can be meanwhile: a fast swing, and errors of depth.
constexpr double kFastestMps = 6, kSlackM = 0.1;

}  // namespace

std::string Challenge::TakeMessage() { return std::exchange(message_, {}); }

void Challenge::LightIsSet(std::int64_t now_ns) { settled_ns_ = now_ns + kLightDelayNs; }

void Challenge::LightFailed() {
  Begin(Step::kAccepted);
  is_unchecked_ = true;
  message_ = "its light cannot be switched: what is seen is not checked";
}

void Challenge::Begin(Step step) {
  const bool was_dark = is_dark();
  step_ = step;
  frames_ = 0;
  settled_ns_.reset();
  began_ns_.reset();
  if (is_dark() != was_dark) ++switches_;
}

/// Whether a hand that was at the trusted place can be there. Across the line of sight: along it
/// the camera measures badly.
bool Challenge::IsNear(const Seen& seen) const {
  if (!trusted_) return false;
  const double apart_s = 1e-9 * static_cast<double>(seen.exposed_ns - trusted_->exposed_ns);
  const Eigen::Vector3d turn = seen.p_C_m.normalized() - trusted_->p_C_m.normalized();
  return turn.norm() * seen.p_C_m.norm() < kSlackM + kFastestMps * apart_s;
}

void Challenge::Refuse(const sphere::Circle& circle, std::int64_t now_ns) {
  refused_.push_back({{circle.centre_px, 1.5 * circle.radius_px + 4}, now_ns + kRefusedForNs});
  ++refusals_;
  message_ = "a light at pixel (" + std::to_string(std::lround(circle.centre_px.x())) + ", " +
             std::to_string(std::lround(circle.centre_px.y())) +
             ") does not follow its light; that place is left out for a minute";
}

void Challenge::DropOld(std::int64_t now_ns) {
  std::erase_if(refused_,
                [&](const Refused& one) { return now_ns > one.until_ns && step_ != Step::kDark; });
  if (trusted_ && now_ns > trusted_->exposed_ns + kTrustedForNs) trusted_.reset();
}

std::vector<sphere::Circle> Challenge::refused() const {
  std::vector<sphere::Circle> places;
  for (const Refused& one : refused_) places.push_back(one.circle);
  return places;
}

void Challenge::Take(const std::optional<sphere::Estimate>& estimate, std::int64_t exposed_ns) {
  if (is_unchecked_) return;
  DropOld(exposed_ns);
  std::optional<Seen> seen;
  if (estimate && estimate->confidence > kLeastConfidence)
    seen = Seen{estimate->p_C_m, {estimate->centre_px, estimate->radius_px}, exposed_ns};
  if (step_ == Step::kDark || step_ == Step::kBack) {
    if (!began_ns_) began_ns_ = exposed_ns;
    if (!settled_ns_ && exposed_ns > *began_ns_ + kSwitchedWithinNs) return LightFailed();
    if (!settled_ns_ || exposed_ns < *settled_ns_) return;
    return step_ == Step::kDark ? TakeDark(seen, exposed_ns) : TakeBack(seen, exposed_ns);
  }
  if (seen && IsNear(*seen)) {
    step_ = Step::kAccepted;
    trusted_ = seen;
  } else if (seen || !trusted_) {
    TakeDoubtful(seen, exposed_ns);
  }
}

void Challenge::TakeDoubtful(const std::optional<Seen>& seen, std::int64_t now_ns) {
  if (step_ != Step::kIdle) Begin(Step::kIdle);
  frames_ = seen ? frames_ + 1 : 0;
  if (frames_ < kSeenFrames || now_ns < not_before_ns_) return;
  dark_refusals_ = 0;
  Begin(Step::kDark);
}

void Challenge::TakeDark(const std::optional<Seen>& seen, std::int64_t now_ns) {
  frames_ = seen ? 0 : frames_ + 1;
  if (seen && now_ns > *settled_ns_ + kStaysLitNs) {
    Refuse(seen->circle, now_ns);  // There may be another one.
    ++dark_refusals_;
  }
  if (frames_ >= kDarkFrames || dark_refusals_ >= kMostRefusals) Begin(Step::kBack);
}

void Challenge::TakeBack(const std::optional<Seen>& seen, std::int64_t now_ns) {
  frames_ += seen ? 1 : 0;
  if (frames_ >= kBackFrames && dark_refusals_ < kMostRefusals) {
    ++passed_;
    message_ = "it follows its light";
    trusted_ = seen;
    Begin(Step::kAccepted);
  } else if (now_ns > *settled_ns_ + kStaysDarkNs) {
    not_before_ns_ = now_ns + kAgainAfterNs;
    Begin(Step::kIdle);
  }
}

LightChecks::LightChecks(const frames::CameraFile& camera, bool challenges, SetLight set,
                         std::function<std::int64_t()> now_ns)
    : challenges_(challenges), set_(std::move(set)), now_ns_(std::move(now_ns)) {
  for (const frames::HeldSphere& one : camera.spheres) held_.push_back({one.role, one.led_rgb});
}

std::uint32_t LightChecks::Wanted(const Held& held) const {
  return held.challenge.is_dark() ? 0 : *held.led_rgb;
}

void LightChecks::TakeMoves(const std::vector<stream::DeviceStatus>& moves) {
  for (Held& held : held_) {
    if (!held.led_rgb) continue;
    const auto move = std::find_if(moves.begin(), moves.end(),
                                   [&](const auto& one) { return one.role == held.role; });
    const auto device = move == moves.end() ? std::optional<std::uint32_t>() : move->device;
    if (device != held.device) {
      passed_before_ += held.challenge.passed();
      refused_before_ += held.challenge.refusals();
      held.challenge = Challenge();
      held.switches = 0;
      held.device = device;
    }
    if (!device || move->sphere_rgb == Wanted(held)) continue;
    set_(*device, Wanted(held), [serial = move->serial](Result<void> done) {
      if (!done) log::Warning(serial + ": its light cannot be set: " + done.error().message);
    });
  }
}

/// Sets a light as its challenge wants it, which waits for that.
void LightChecks::Switch(std::size_t sphere) {
  const Held& held = held_[sphere];
  set_(*held.device, Wanted(held),
       [this, sphere, device = held.device, switches = held.switches](Result<void> done) {
         Held& now = held_[sphere];
         if (now.device != device || now.switches != switches) return;
         if (done) {
           now.challenge.LightIsSet(now_ns_());
         } else {
           now.challenge.LightFailed();
         }
       });
}

void LightChecks::TakeFrame(std::int64_t exposed_ns, sphere::Finder& finder,
                            std::vector<std::optional<sphere::Estimate>>& found) {
  if (!challenges_) return;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    Held& held = held_[i];
    if (!held.device) {
      finder.LeaveOut(i, {});
      continue;
    }
    held.challenge.Take(found[i], exposed_ns);
    finder.LeaveOut(i, held.challenge.refused());
    if (const std::string message = held.challenge.TakeMessage(); !message.empty())
      log::Info(std::string(stream::Name(held.role)) + ": " + message);
    if (!held.challenge.accepts()) found[i].reset();
    if (std::exchange(held.switches, held.challenge.switches()) != held.switches) Switch(i);
  }
}

std::vector<LightVerdict> LightChecks::Verdicts() const {
  std::vector<LightVerdict> verdicts(held_.size());
  for (std::size_t i = 0; i < held_.size(); ++i) {
    if (!challenges_ || !held_[i].device) continue;
    const Challenge& challenge = held_[i].challenge;
    verdicts[i].accepts = challenge.accepts();
    verdicts[i].is_switching = challenge.is_dark() || challenge.step() == Challenge::Step::kBack;
    verdicts[i].refused = challenge.refused();
  }
  return verdicts;
}

int LightChecks::passed() const {
  int sum = passed_before_;
  for (const Held& held : held_) sum += held.challenge.passed();
  return sum;
}

int LightChecks::refusals() const {
  int sum = refused_before_;
  for (const Held& held : held_) sum += held.challenge.refusals();
  return sum;
}

}  // namespace footing::camera
