#pragma once

#include <cstdint>

#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::scene {

/// The way from received ticks to what is drawn at an instant.
class Show {
 public:
  struct Shot {
    WorldFrame frame;  ///< Empty until the first character came.
    Picture picture;
  };

  Model& model() { return model_; }
  const Model& model() const { return model_; }

  /// Takes a tick in for display; `now_ns` is when, for its latency.
  void Take(const Update& update, std::int64_t now_ns);

  /// What to draw at `now_ns`, which never runs back. Frozen, the world stands still.
  Shot At(std::int64_t now_ns, bool frozen, const StageOptions& options);

 private:
  Model model_;
  Stage stage_;
  WorldFrame frame_;
  std::int64_t last_ns_ = 0;
};

}  // namespace footing::scene
