#include "daemon/offline/tune/dimension.h"

#include "common/base/result.h"

namespace footing::tune {

void AddDimensions(const std::vector<DimensionRow>& rows, std::vector<Dimension>& dimensions) {
  for (const DimensionRow& row : rows) {
    const gait::GainField* gain = gait::FindGain(row.gain);
    FOOTING_CHECK(gain != nullptr);
    dimensions.push_back({gain, row.scale, row.relative});
  }
}

}  // namespace footing::tune
