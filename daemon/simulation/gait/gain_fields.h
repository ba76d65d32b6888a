#pragma once

#include <span>
#include <string_view>

#include "daemon/simulation/gait/gains.h"

namespace footing::gait {

/// One number of Gains, as a column of a gait table.
struct GainField {
  std::string_view name;  ///< "section.field" as in gains.h.
  std::string_view unit;
  double min, max;        ///< Range allowed in a table.
  double& (*of)(Gains&);  ///< Where it is.

  double Of(const Gains& gains) const { return of(const_cast<Gains&>(gains)); }  // NOLINT: read
};

/// Every number of gains.h, in its order. A new one is one line of gain_fields.cc.
std::span<const GainField> GainFields();

/// Null when there is no gain of this name.
const GainField* FindGain(std::string_view name);

}  // namespace footing::gait
