#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/frames/camera_file.h"
#include "common/stream/device.h"

namespace footing::camera {

/// Makes sure that what is seen as a sphere is the one whose light is switched, and no lamp of its
/// colour. In doubt the light goes out: what stays lit is refused, and its place in the image is
/// left out for a while; what goes out and comes back is accepted. A sphere is in doubt when it
/// appears or jumps; one that was accepted and reappears where a hand can have taken it is not.
/// It has no clock and switches nothing itself.
class Challenge {
 public:
  enum class Step {
    kIdle,  ///< Nothing to be seen, or it was checked a moment ago.
    kDark,  ///< Its light goes out.
    kBack,  ///< Its light is on again.
    kAccepted,
  };

  /// Takes the finder's estimate of the sphere in a frame; nothing: not seen.
  void Take(const std::optional<sphere::Estimate>& seen, std::int64_t exposed_ns);
  /// The light has been set as `is_dark` says, since then; frames of earlier show the one before.
  void LightIsSet(std::int64_t now_ns);
  /// The light cannot be set: no challenge, everything is accepted.
  void LightFailed();

  /// Whether the light must be out now.
  bool is_dark() const { return step_ == Step::kDark; }
  /// Grows whenever the light is to be set.
  int switches() const { return switches_; }
  /// Whether what the last frame showed is the sphere.
  bool accepts() const { return step_ == Step::kAccepted; }
  Step step() const { return step_; }
  /// Places in the image that the finder must leave out now.
  std::vector<sphere::Circle> refused() const;

  int passed() const { return passed_; }      ///< Challenges that a sphere passed.
  int refusals() const { return refusals_; }  ///< Lights that did not follow.
  std::string TakeMessage();                  ///< Message for the log; empty: nothing new.

 private:
  struct Seen {
    Eigen::Vector3d p_C_m;
    sphere::Circle circle;
    std::int64_t exposed_ns;
  };
  struct Refused {
    sphere::Circle circle;
    std::int64_t until_ns;
  };

  void TakeDoubtful(const std::optional<Seen>& seen, std::int64_t now_ns);
  void TakeDark(const std::optional<Seen>& seen, std::int64_t now_ns);
  void TakeBack(const std::optional<Seen>& seen, std::int64_t now_ns);
  void Begin(Step step);
  void Refuse(const sphere::Circle& circle, std::int64_t now_ns);
  void DropOld(std::int64_t now_ns);
  bool IsNear(const Seen& seen) const;

  Step step_ = Step::kIdle;
  bool is_unchecked_ = false;
  int switches_ = 0;
  int frames_ = 0;  ///< Frames of this step that count towards its end.
  int passed_ = 0, refusals_ = 0, dark_refusals_ = 0;
  std::optional<Seen> trusted_;  ///< Where it was seen last, accepted.
  std::optional<std::int64_t> began_ns_, settled_ns_;
  std::int64_t not_before_ns_ = 0;
  std::vector<Refused> refused_;
  std::string message_;
};

/// How long after footingd's answer a frame may still show the light before: footingd sends a
/// Move's light ten times a second at most; then come the radio and an exposure.
inline constexpr std::int64_t kLightDelayNs = 400'000'000;

/// How the light of one sphere stands, for a person.
struct LightVerdict {
  bool accepts = true;        ///< A find counts as the sphere.
  bool is_switching = false;  ///< Its light is out, or on its way back.
  std::vector<sphere::Circle> refused;
};

/// The lights of the controllers that hold the camera file's spheres: lit in the colour that is
/// tracked, and switched where a challenge wants it. Spheres without a controller, or without a
/// light in the file, are not checked.
class LightChecks {
 public:
  using Done = std::function<void(Result<void>)>;
  using SetLight = std::function<void(std::uint32_t device, std::uint32_t rgb, Done done)>;

  /// `challenges`: whether lights may go out to check spheres. `now_ns`: the frames' clock.
  LightChecks(const frames::CameraFile& camera, bool challenges, SetLight set,
              std::function<std::int64_t()> now_ns);

  /// The controllers that are there. Lights those that have another light than they should.
  void TakeMoves(const std::vector<stream::DeviceStatus>& moves);
  /// Takes out what is not, or not yet, accepted as the sphere; `finder` leaves out what was
  /// refused.
  void TakeFrame(std::int64_t exposed_ns, sphere::Finder& finder,
                 std::vector<std::optional<sphere::Estimate>>& found);

  /// Verdict on every sphere, after TakeFrame.
  std::vector<LightVerdict> Verdicts() const;

  int passed() const;
  int refusals() const;

 private:
  struct Held {
    stream::DeviceRole role;
    std::optional<std::uint32_t> led_rgb;
    std::optional<std::uint32_t> device = {};
    Challenge challenge = {};
    int switches = 0;  ///< Switches of the challenge that were sent.
  };
  std::uint32_t Wanted(const Held& held) const;
  void Switch(std::size_t sphere);

  bool challenges_;
  SetLight set_;
  std::function<std::int64_t()> now_ns_;
  std::vector<Held> held_;
  int passed_before_ = 0, refused_before_ = 0;  ///< Counts of controllers that are gone.
};

}  // namespace footing::camera
