#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/sensor/setup/storage.h"

namespace footing::setup {

/// The calibrations of devices that cannot always be read from the device, each by its serial.
class CalibrationStore {
 public:
  explicit CalibrationStore(Storage storage) : storage_(std::move(storage)) {}

  /// None if none was saved for this device, or what was saved is refused.
  std::optional<std::vector<std::uint8_t>> Load(const std::string& serial) const;
  void Save(const std::string& serial, const std::vector<std::uint8_t>& bytes) const;

 private:
  Storage storage_;
};

}  // namespace footing::setup
