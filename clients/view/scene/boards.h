#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "clients/view/scene/model.h"
#include "clients/view/scene/part.h"
#include "common/board/geometry.h"

namespace footing::scene {

/// A board as it lies, with its newest sample where there is one.
struct PlacedBoard {
  stream::BoardPose pose;
  bool live = false;  ///< A sample came within the last half second.
  stream::BoardSample sample;
  stream::BoardGeometry geometry = board::kBalanceBoard;

  /// A point of the plate frame P in W.
  Eigen::Vector2d InWorld(double right_m, double front_m) const;
  /// Sensors in the order top left, top right, bottom left, bottom right.
  std::array<Eigen::Vector2d, board::kCorners> Sensors() const;
  std::array<double, 4> Loads() const;
};

/// The left and the right board of a rig by its published layout, or by the default one.
std::array<PlacedBoard, 2> BoardsOf(const Model& model, const std::string& rig,
                                    std::int64_t now_ns);

/// The geometry in force of a board, by {source, device}.
stream::BoardGeometry GeometryOf(const Model& model, const std::pair<int, std::uint32_t>& board);

/// Two plates with their surface at z = 0.
void AddPlates(const std::array<PlacedBoard, 2>& boards, PartList& parts);
/// The same, and on each sensor a column as high as its load.
void AddBoards(const std::array<PlacedBoard, 2>& boards, PartList& parts);

/// Left is blue, right is amber, in the whole picture.
Colour SideColour(std::size_t side);

}  // namespace footing::scene
