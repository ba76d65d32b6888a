#pragma once

#include <string>

#include "common/base/result.h"
#include "daemon/sensor/setup/stored_setup.h"

/// The stored set-up as JSON text, each part a file of its own. A part is read as a whole or not at
/// all: a missing key or a wrong type is an error. Numbers that are not finite are read as 0.
namespace footing::setup {

std::string ToJson(const Roles& roles);
std::string ToJson(const Tares& tares);
std::string ToJson(const Mountings& mountings);
std::string ToJson(const Layouts& layouts);
std::string ToJson(const Items& items);
std::string ToJson(const MovedBoards& boards);
std::string ToJson(const StoredCalibration& calibration);

Result<Roles> RolesFromJson(const std::string& text);
Result<Tares> TaresFromJson(const std::string& text);
/// Without the mountings whose quaternion is not a rotation.
Result<Mountings> MountingsFromJson(const std::string& text);
Result<Layouts> LayoutsFromJson(const std::string& text);
Result<Items> ItemsFromJson(const std::string& text);
Result<MovedBoards> MovedBoardsFromJson(const std::string& text);
/// At least one byte, in hex.
Result<StoredCalibration> CalibrationFromJson(const std::string& text);

}  // namespace footing::setup
