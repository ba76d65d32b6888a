#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "clients/view/app/view_mouse.h"
#include "clients/view/scene/sound.h"
#include "common/base/result.h"

namespace footing::view {

/// The machine's sound, by OpenAL. It mixes all sounds: none waits for another.
class Speaker {
 public:
  /// Fails where the machine has no sound, or this program was built without OpenAL.
  static Result<Speaker> Open();
  Speaker(Speaker&&) noexcept;
  Speaker& operator=(Speaker&&) = delete;
  ~Speaker();

  /// Begins each at once; at most 16 sound together, then the oldest ends.
  void Play(const std::vector<scene::Sound>& sounds);

 private:
  struct Device;
  explicit Speaker(std::unique_ptr<Device> device);

  std::unique_ptr<Device> device_;
};

/// Sounds of a view; they are heard where that was asked for.
class ViewSounds {
 public:
  /// Where the machine has no sound the log says so, and the view goes on without.
  explicit ViewSounds(bool wanted);

  /// Plays the sounds of the first view, as it was just drawn, and returns them; to be called with
  /// every picture.
  std::vector<scene::Sound> Follow(const std::vector<DrawnView>& views);

 private:
  std::optional<Speaker> speaker_;
  scene::SoundFinder finder_;
};

}  // namespace footing::view
