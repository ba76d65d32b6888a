#pragma once

#include <cstdint>
#include <memory>

#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::scene {

/// The way from received ticks to what is drawn at an instant.
class Show {
 public:
  struct Shot {
    WorldFrame frame;  ///< Empty until the first character came.
    Picture picture;
    const Model& past;         ///< The model as it was when the scene was frozen, else that of now.
    std::int64_t past_ns = 0;  ///< When that was, else now.
  };

  Model& model() { return model_; }
  const Model& model() const { return model_; }

  /// Takes a tick in for display; `now_ns` is when, for its latency.
  void Take(const Update& update, std::int64_t now_ns);

  /// From now on every fall is shown again in slow motion as soon as it is over.
  void ReplayFalls() { replays_falls_ = true; }
  /// Shows the last fall again in slow motion, or ends that.
  void ToggleReplay(std::int64_t now_ns);

  /// What to draw at `now_ns`, which never runs back. Frozen, the world and all that slides with
  /// time stand still.
  Shot At(std::int64_t now_ns, bool frozen, const StageOptions& options);

  /// Playback moves on in steps of its own, so that what is shown depends on the time alone and not
  /// on when it was drawn: Step moves the camera and all that is filtered to `now_ns`, Peek shows
  /// an instant at or behind the last step and leaves that step as it is.
  void Step(std::int64_t now_ns, const StageOptions& options);
  Shot Peek(std::int64_t now_ns, const StageOptions& options);

 private:
  WorldFrame FrameAt(std::int64_t now_ns);
  WorldFrame ShownAt(std::int64_t now_ns) const;
  double PassedS(std::int64_t now_ns) const;

  struct Frozen {
    Model model;
    std::int64_t at_ns = 0;
  };

  Model model_;
  Stage stage_;
  WorldFrame frame_;
  std::unique_ptr<const Frozen> frozen_;
  std::int64_t last_ns_ = 0;
  bool replays_falls_ = false;
  std::uint64_t replayed_ = 0;  ///< Clips that were there at the last look.
};

}  // namespace footing::scene
