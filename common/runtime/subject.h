#pragma once

#include <string>

#include "common/base/result.h"

namespace footing::subject {

/// Who stands on the boards.
struct Subject {
  std::string code;          ///< Code in the study; empty: nobody has been named.
  double height_m = 0;       ///< Standing, 1.0 to 2.3.
  double mass_kg = 0;        ///< 20 to 250; 0: as the T-pose weighs it.
  double foot_length_m = 0;  ///< Heel to tip, 0.15 to 0.36; 0: by height.
};

/// Without a subject file: of middle height, weighed by the T-pose.
Subject UnnamedSubject();

/// Error with `origin` and the allowed range; a code has 1 to 32 letters, digits, - and _.
Result<void> CheckSubject(const Subject& subject, const std::string& origin);

/// A JSON object {code, height_m, mass_kg?, foot_length_m?}; unknown keys are errors.
Result<Subject> ReadSubject(const std::string& path);

}  // namespace footing::subject
