#include "clients/view/scene/boards.h"

#include <algorithm>
#include <cmath>

#include "common/board/layout.h"

namespace footing::scene {
namespace {

using Eigen::Vector3f;

constexpr std::int64_t kStaleNs = 500'000'000;
constexpr float kColumnPerN = 0.25f / 400;  // A quarter of a metre for a person on one cell.
constexpr float kLowestColumnM = 0.004f;
constexpr float kColumnRadiusM = 0.016f;

Vector3f At(const Eigen::Vector2d& p_m, double z_m) {
  return Eigen::Vector3d(p_m.x(), p_m.y(), z_m).cast<float>();
}

void AddPlate(const PlacedBoard& board, const Colour& accent, PartList& parts) {
  const auto turn = static_cast<float>(board.pose.yaw_rad);
  Eigen::Matrix3f axes;  // Columns: right, front, up.
  axes << std::sin(turn), std::cos(turn), 0, -std::cos(turn), std::sin(turn), 0, 0, 0, 1;
  const auto box = [&](double right_m, double front_m, double z_m, const Vector3f& sides_m,
                       const Colour& colour, float gloss) {
    parts.AddBox(At(board.InWorld(right_m, front_m), z_m), axes, sides_m, colour, gloss);
  };
  const auto wide = static_cast<float>(board.geometry.plate_x_m),
             deep = static_cast<float>(board.geometry.plate_y_m),
             high = static_cast<float>(board::kPlateHeightM);
  const Colour body = board.live ? Rgb(0xe8ebee) : Rgb(0x8d949b);
  const Colour pad = board.live ? Rgb(0xd3d8dd) : Rgb(0x7d848b);
  box(0, 0, -0.60 * high, {wide, deep - 0.03f, 0.8f * high}, body, 0.3f);
  box(0, 0, -0.60 * high, {wide - 0.03f, deep, 0.8f * high}, body, 0.3f);
  box(0, 0, -0.11 * high, {wide - 0.02f, deep - 0.02f, 0.2f * high}, body, 0.3f);
  for (const double right : {-1.0, 1.0}) {
    for (const double front : {-1.0, 1.0}) {
      box(right * 0.121, front * 0.073, -0.0019, {0.228f, 0.130f, 0.004f}, pad, 0.05f);
    }
  }
  // The edge with the power button says which board it is.
  box(0, -0.5 * deep + 0.004, -0.5 * high, {0.16f, 0.012f, 0.016f}, accent, 0.4f);
}

void AddColumns(const PlacedBoard& board, const Colour& accent, PartList& parts) {
  const auto sensors = board.Sensors();
  const auto loads = board.Loads();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const float height = std::max(kLowestColumnM, kColumnPerN * static_cast<float>(loads[i]));
    const Vector3f foot = At(sensors[i], 0);
    parts.AddRod(foot, foot + Vector3f(0, 0, height), kColumnRadiusM, kColumnRadiusM, accent, 0.3f);
    parts.AddDisc(foot + Vector3f(0, 0, height), {kColumnRadiusM, kColumnRadiusM}, 0, accent);
  }
}

}  // namespace

Eigen::Vector2d PlacedBoard::InWorld(double right_m, double front_m) const {
  return board::InWorld(pose, right_m, front_m);
}

std::array<Eigen::Vector2d, board::kCorners> PlacedBoard::Sensors() const {
  return board::SensorPlaces(pose, geometry);
}

std::array<double, 4> PlacedBoard::Loads() const {
  if (!live) return {};
  return {sample.top_left_n, sample.top_right_n, sample.bottom_left_n, sample.bottom_right_n};
}

Colour SideColour(std::size_t side) { return side == 0 ? Rgb(0x3f8fe0) : Rgb(0xf2a33c); }

stream::BoardGeometry GeometryOf(const Model& model, const std::pair<int, std::uint32_t>& board) {
  for (const Device& device : model.devices) {
    if (std::pair(device.source, device.status.device) != board) continue;
    const bool left = device.status.role == stream::DeviceRole::kLeftBoard;
    for (const stream::RigSetup& setup : model.setup) {
      if (setup.rig != device.status.rig) continue;
      return board::GeometryOr(left ? setup.layout.left_geometry : setup.layout.right_geometry);
    }
  }
  return board::kBalanceBoard;
}

std::array<PlacedBoard, 2> BoardsOf(const Model& model, const std::string& rig,
                                    std::int64_t now_ns) {
  stream::BoardLayout layout = board::DefaultLayout();
  for (const stream::RigSetup& setup : model.setup) {
    if (setup.rig == rig) layout = board::LayoutOr(setup.layout);
  }
  std::array<PlacedBoard, 2> boards;
  boards[0].pose = layout.left;
  boards[0].geometry = board::GeometryOr(layout.left_geometry);
  boards[1].pose = layout.right;
  boards[1].geometry = board::GeometryOr(layout.right_geometry);
  for (const Device& device : model.devices) {
    if (device.status.rig != rig) continue;
    const bool left = device.status.role == stream::DeviceRole::kLeftBoard;
    if (!left && device.status.role != stream::DeviceRole::kRightBoard) continue;
    const auto trace = model.boards.find({device.source, device.status.device});
    if (trace == model.boards.end()) continue;
    PlacedBoard& board = boards[left ? 0 : 1];
    board.sample = trace->second.newest;
    board.live = now_ns - trace->second.newest_ns < kStaleNs;
  }
  return boards;
}

void AddPlates(const std::array<PlacedBoard, 2>& boards, PartList& parts) {
  for (std::size_t side = 0; side < boards.size(); ++side)
    AddPlate(boards[side], SideColour(side), parts);
}

void AddBoards(const std::array<PlacedBoard, 2>& boards, PartList& parts) {
  AddPlates(boards, parts);
  for (std::size_t side = 0; side < boards.size(); ++side) {
    AddColumns(boards[side], SideColour(side), parts);
  }
}

}  // namespace footing::scene
