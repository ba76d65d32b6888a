#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/camera/camera_pose.h"
#include "common/guide/recent.h"
#include "common/stream/setup.h"

namespace footing::guide {

/// A mark while a camera's pose is calibrated, for whoever draws it.
struct MarkState {
  enum class Stage { kToCome, kNext, kTaken };
  std::string name;
  Eigen::Vector3d p_W_m{0, 0, 0};  ///< Centre of a sphere that lies on it.
  Stage stage = Stage::kToCome;
  std::optional<double> residual_m = {};  ///< Residual of the pose, once there is one.
};

/// Progress of a camera's calibration, for whoever draws it.
struct MarksState {
  std::vector<MarkState> marks;
  bool upright = false;           ///< The controller stands on the next mark, sphere up.
  std::size_t done = 0, all = 0;  ///< Places, upright ones included.
  double rest_share = 0;          ///< Share of the time for which the sphere must rest.
  std::optional<Eigen::Isometry3d> X_WC = {};  ///< The pose, once there is one.
};

/// The items of a set-up, in their order.
enum class Item { kAdapter, kPairing, kRoles, kLayout, kTare, kMounting, kWeigh, kCamera, kChecks };

/// Name of an item on command lines, the item of a name, and all items in their order.
const char* Name(Item item);
std::optional<Item> ItemNamed(const std::string& name);
const std::vector<Item>& AllItems();

/// Options of the command line.
struct SetUpOptions {
  std::string rig = "main";
  std::string preset;  ///< Empty: the rig's own layout, else one_foot_each (or single).
  double gap_mm = kNoGapMm;
  /// Roles of the hand devices, each once; empty: their present roles.
  std::vector<stream::DeviceRole> body_roles;
  /// The item mounting was asked for by name: also of remotes in the hands.
  bool mount_all = false;
  std::optional<double> mass_kg;
  double patience_s = 60;  ///< Timeout of an item that makes no progress.
  double settle_s = 4;     ///< Without a new device in this time, all are there.
  int tries = 2;
  std::string camera_file;  ///< File of the camera that is calibrated; empty: none is.
  /// Which of its spheres is held on the marks, and how large it is.
  stream::DeviceRole camera_role = stream::DeviceRole::kUnspecified;
  double camera_radius_m = 0;
  /// Height of a person who holds both spheres in three poses; 0: one is held on marks.
  double poses_height_m = 0;
  double fist_to_sphere_m = camera_pose::kFistToSphereM;

  static constexpr double kNoGapMm = -1;  ///< The default one.
};

/// Something that footingd is asked to do, or is written into a file. The answer comes back under
/// the same key.
struct Action {
  enum class Kind { kAssign, kTare, kSolveMounting, kLayout, kStoreCamera };
  Kind kind = Kind::kAssign;
  std::string key;
  std::string serial;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  stream::BoardLayout layout;
  double window_s = 0;
  std::int64_t still_from_ns = 0;
  std::int64_t still_to_ns = 0;
  std::int64_t steps_from_ns = 0;
  std::int64_t steps_to_ns = 0;
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();  ///< Pose for kStoreCamera.
  std::string remark;                                      ///< Likewise.
};

/// Answer to an action.
struct Answer {
  std::string key;
  bool ok = false;
  std::string message;  ///< Reason of a refusal, or a remark.
  double residual = 0;
  std::string unit;
};

/// All that an item sees in one instant.
struct Situation {
  std::int64_t now_ns = 0;  ///< footingd's clock.
  const Recent* recent = nullptr;
  const std::vector<stream::RigSetup>* setup = nullptr;
  std::vector<std::string> adapters;  ///< Bluetooth adapters of the host.
  std::vector<Answer> answers;        ///< To earlier actions, each once.
  bool enter = false;                 ///< The person pressed Enter since the last instant.
};

/// Output of an item at that instant.
struct Progress {
  std::string prompt;   ///< To the person; the same until something else is asked.
  std::string picture;  ///< Goes with the prompt; may be empty.
  /// The same as a number, for who performs it without reading; of which device, if of one.
  stream::Gesture gesture = stream::Gesture::kUnspecified;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  std::string feedback;             ///< Current observation; changes all the time.
  std::optional<MarksState> marks;  ///< Marks of a camera's calibration.
  std::vector<Action> actions;
  std::vector<stream::SetupItem> results;  ///< Without rig, date and staleness.
  bool finished = false;
};

/// A result of an item, short to write.
stream::SetupItem Outcome(Item item, const std::string& serial, bool passed, double residual,
                          const std::string& unit, const std::string& note);

/// Calibrates where a camera stands: the person holds a sphere on each mark of the boards and, with
/// a PS Move, stands it upright on one mark of each board, for gravity. Or the person stands on the
/// boards and holds the spheres of both hands in three poses. Without a camera file in the options
/// it finishes at once, without a result.
class CameraStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  /// A stretch of the place's spheres at rest, or why there is none yet.
  struct Rest {
    std::vector<camera_pose::SeenMark> seen;  ///< One, in poses both; empty: none yet.
    double tilt_rad = 0;                      ///< Tilt of the controller's long axis.
    std::string feedback;
    double share = 0;  ///< Share of the stretch.
  };

  void Begin(const Situation& now, const SetUpOptions& options);
  /// Begin of the stretch in which the spheres are to rest: long enough, and with enough frames.
  std::int64_t RestFrom(const Situation& now, const SetUpOptions& options) const;
  Rest Look(const Situation& now, const SetUpOptions& options) const;
  /// Centre of pressure of who stands on the boards, W; nothing when nobody does.
  std::optional<Eigen::Vector2d> Standing(const Situation& now, const SetUpOptions& options,
                                          std::int64_t from_ns) const;
  /// Why the spheres at rest cannot be at the place that is asked for; empty when they can.
  std::string Doubt(const Rest& rest) const;
  void Take(const Rest& rest);
  Progress Ask() const;
  Progress Ask(const Rest& rest) const;
  MarksState Marks(double rest_share) const;
  Progress Solve();
  Progress Stored(const Situation& now);

  bool begun_ = false, stored_ = false;
  stream::BoardLayout layout_;
  std::vector<camera_pose::Mark> marks_;
  std::vector<stream::DeviceRole> roles_;  ///< Spheres of a place: one, in poses both hands'.
  std::vector<std::size_t> places_;        ///< First of marks_, in the order asked for.
  std::vector<bool> upright_;              ///< Whether each place is an upright one.
  std::size_t next_ = 0;                   ///< Index into places_.
  std::int64_t asked_ns_ = 0;              ///< When the present place was asked for.
  std::string picture_;
  camera_pose::Observations observations_;
  camera_pose::CameraPose pose_;
};

}  // namespace footing::guide
