#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "clients/camera/challenge.h"
#include "common/frames/camera_file.h"
#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/stream/device.h"

namespace footing::camera {

/// How the light of one sphere stands, for a person.
struct LightVerdict {
  bool accepts = true;        ///< What is found is taken for the sphere.
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

  /// Of every sphere, after TakeFrame.
  std::vector<LightVerdict> Verdicts() const;

  int passed() const;
  int refusals() const;

 private:
  struct Held {
    stream::DeviceRole role;
    std::optional<std::uint32_t> led_rgb;
    std::optional<std::uint32_t> device = {};
    Challenge challenge = {};
    int switches = 0;  ///< Of the challenge, as sent.
  };
  std::uint32_t Wanted(const Held& held) const;
  void Switch(std::size_t sphere);

  bool challenges_;
  SetLight set_;
  std::function<std::int64_t()> now_ns_;
  std::vector<Held> held_;
  int passed_before_ = 0, refused_before_ = 0;  ///< With controllers that are gone.
};

}  // namespace footing::camera
