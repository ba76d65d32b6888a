#include "common/base/units.h"

#include <cmath>

namespace footing {

double WrapAngle(double radians) {
  const double wrapped = std::remainder(radians, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace footing
