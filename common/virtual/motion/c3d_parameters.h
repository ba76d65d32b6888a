#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/c3d_reader.h"

namespace footing::motion {

/// The parameter section of a C3D file: "GROUP:NAME" in capitals to its values.
struct C3dParameters {
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::vector<std::string>> texts;

  /// The first value, or `otherwise`.
  double Number(const std::string& name, double otherwise) const;
  std::string Text(const std::string& name) const;
  /// LABELS, LABELS2, LABELS3, ... in one list.
  std::vector<std::string> Labels(const std::string& group) const;
};

/// Reads the section that begins at byte `begin`.
Result<C3dParameters> ParseC3dParameters(const C3dReader& reader, std::size_t begin,
                                         const std::string& file);

}  // namespace footing::motion
