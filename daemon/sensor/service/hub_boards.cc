// The boards of a rig, and whether its layout is for as many.
#include <algorithm>

#include "common/board/layout.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

using decode::Placement;

constexpr std::size_t kMostRigBytes = 64;

}  // namespace

std::set<std::string> Hub::RigsWithBoards() const {
  std::set<std::string> rigs;
  for (const auto& device : devices_) {
    if (device->placement() == Placement::kUnderFeet) rigs.insert(device->binding().rig);
  }
  return rigs;
}

std::size_t Hub::AttachedBoards(const std::string& rig) const {
  return static_cast<std::size_t>(
      std::count_if(devices_.begin(), devices_.end(), [&rig](const auto& device) {
        return device->attached() && device->placement() == Placement::kUnderFeet &&
               device->binding().rig == rig;
      }));
}

/// A second board that comes to a layout of one is reported once, and the layout is to be redone.
void Hub::WatchLayouts() {
  for (const std::string& rig : RigsWithBoards()) {
    const std::string problem = board::ProblemWith(store_.LayoutOf(rig), AttachedBoards(rig), rig);
    if (problem.empty()) {
      if (crowded_rigs_.erase(rig) > 0) status_due_ = true;
    } else if (crowded_rigs_.insert(rig).second) {
      store_.MarkStale(rig, "layout", "", problem);
      status_due_ = true;
      ports_.log({problem, "", true});
    }
  }
}

/// A board that should be one of two is alone, or one that should be alone is not; empty when all
/// is well.
std::string Hub::BoardNote(const stream::DeviceStatus& status) const {
  if (status.state == stream::DeviceState::kLost) return "";
  const std::size_t boards = AttachedBoards(status.rig);
  const stream::BoardLayout layout = store_.LayoutOf(status.rig);
  if (layout.preset == "single") return board::ProblemWith(layout, boards, status.rig);
  return boards < 2
             ? "one board alone: weight beside it is not measured; switch the other on, or say "
               "that there is none: footing-ctl layout --preset single"
             : "";
}

Result<Hub::Measured> Hub::SetBoardLayout(stream::BoardLayout layout) {
  if (layout.rig.empty()) layout.rig = config_.default_rig;
  if (layout.rig.size() > kMostRigBytes) return UsageError("layout: the rig's name is too long");
  if (auto problem = board::Problem(layout); !problem.empty()) return UsageError(problem);
  if (auto problem = board::ProblemWith(layout, AttachedBoards(layout.rig), layout.rig);
      !problem.empty()) {
    return UsageError(problem);
  }
  const stream::BoardLayout before = store_.LayoutOf(layout.rig);
  const auto same = [](const stream::BoardPose& a, const stream::BoardPose& b) {
    return a.x_m == b.x_m && a.y_m == b.y_m && a.yaw_rad == b.yaw_rad;
  };
  const bool changed = before.preset != layout.preset || before.gap_mm != layout.gap_mm ||
                       !same(before.left, layout.left) || !same(before.right, layout.right);
  if (!store_.SetLayout(layout)) return Failure("layout: there are too many rigs already");
  if (changed) {
    store_.MarkStale(layout.rig, "layout", "", "the layout was changed and not checked since");
  }
  return Measured{0, "",
                  layout.preset == "single"
                      ? "one board alone: left and right foot cannot be distinguished"
                      : ""};
}

}  // namespace footing::sensor
