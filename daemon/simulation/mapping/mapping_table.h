#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

/// The files NAME_mapping.json: from a person's comfortable range to the character's stable one
/// (gait paper, section 7).
namespace footing::mapping {

/// Two ends of a linear, clamped scaling.
struct Scaling {
  double from_min = 0, from_max = 1;
  double to_min = 0, to_max = 1;

  double operator()(double from) const;
  /// Whether `from` has a length and `to` does not fall.
  bool Rises() const { return from_min < from_max && to_min <= to_max; }
};

/// Of a number in the file; it is stored in SI.
enum class Unit { kSi, kDegrees };

/// One number of a table.
struct TableField {
  const char* key;
  double* value;
  double min, max;
  Unit unit = Unit::kSi;
};
using TableFields = std::vector<TableField>;

/// One choice of a table, true or false; a table may be without it.
struct TableFlag {
  const char* key;
  bool* value;
};

/// Reads a table: the version 1, how the numbers were found, where measured ones come from, every
/// key of `fields`, nothing unknown but `flags`, all in range. `origin` names the file.
Result<void> ReadTable(const std::string& text, const std::string& origin,
                       const TableFields& fields, const std::vector<TableFlag>& flags = {});

/// The error for a table whose numbers contradict each other.
Error NotOrdered(const std::string& origin);

/// The four ends of a scaling, with the range that each may have.
struct ScalingKeys {
  const char *from_min, *from_max, *to_min, *to_max;
  double least_from, most_from, least_to, most_to;
};
void AddFields(const ScalingKeys& keys, Scaling& scaling, TableFields& fields);
/// Speeds of walking and running by a limb's frequency.
void AddSpeedFields(Scaling& walk_mps_from_hz, Scaling& run_mps_from_hz, TableFields& fields);

}  // namespace footing::mapping
