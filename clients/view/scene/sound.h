#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/update.h"

/// Sounds of steps, landings and wings: which there are comes from the contacts of the frames that
/// are shown, how each sounds from its impact. No file of sounds is needed.
namespace footing::scene {

enum class SoundKind {
  kStep,     ///< A foot touches.
  kLanding,  ///< The first foot after a flight as long as a jump's.
  kWings,    ///< The wings open, early in such a flight.
};

/// One sound, of something in the picture.
struct Sound {
  SoundKind kind = SoundKind::kStep;
  double impact_mps = 0;   ///< Speed at which it hits the ground, or, of wings, leaves it.
  double gain = 0;         ///< Peak at the ear, 0 to 1.
  double pan = 0;          ///< -1 at the left edge of the picture, 1 at the right one.
  std::uint32_t seed = 0;  ///< Number of its noise: no two steps sound the same.
  std::uint32_t character = 0;
  int foot = -1;  ///< Contact that touched: 0 is the left one; -1: none did.
};

/// Peak of a sound at the distance of the usual view: it grows with the impact, to 1.
double GainOfImpact(double impact_mps);

/// One channel, a number of samples a second; the peak is the sound's gain. The same sound gives
/// the same samples.
std::vector<float> Synthesized(const Sound& sound, int rate_hz);

/// Finds the sounds from frame to frame. Nothing sounds where the time jumps (a pause, a seek) or a
/// character is put back.
class SoundFinder {
 public:
  /// The frame shown next, and how it is seen. `aspect` is width over height of the picture.
  std::vector<Sound> Advance(const WorldFrame& frame, const Camera& camera, double aspect);

 private:
  struct Heard {
    double time_s = 0;
    Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
    double descent_mps = 0;
    std::vector<stream::Contact> contacts;
    double airborne_s = 0;
    bool wings = false;  ///< They have sounded in this flight.
  };
  void Listen(std::uint32_t character, const Heard& before, Heard& now, const Camera& camera,
              double aspect, std::vector<Sound>& sounds);

  std::map<std::uint32_t, Heard> heard_;  ///< By character.
  std::uint32_t count_ = 0;
};

}  // namespace footing::scene
