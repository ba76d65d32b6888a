#include "daemon/sensor/setup/calibration_store.h"

#include "daemon/sensor/setup/setup_json.h"

namespace footing::setup {
namespace {

std::string NameOf(const std::string& serial) { return "calibration-" + serial; }

}  // namespace

std::optional<std::vector<std::uint8_t>> CalibrationStore::Load(const std::string& serial) const {
  auto stored = setup::Load(storage_, NameOf(serial), CalibrationFromJson);
  if (!stored) return std::nullopt;
  if (stored->serial == serial) return std::move(stored->bytes);
  if (storage_.refuse) storage_.refuse(NameOf(serial), "it is of another device");
  return std::nullopt;
}

void CalibrationStore::Save(const std::string& serial,
                            const std::vector<std::uint8_t>& bytes) const {
  if (storage_.save) storage_.save(NameOf(serial), ToJson(StoredCalibration{serial, bytes}));
}

}  // namespace footing::setup
