#include "common/board/stance.h"

#include <algorithm>

namespace footing::board {
namespace {

constexpr double kWeighingS = 3;

}  // namespace

Stance StanceOn(const FootLoad& left, const FootLoad& right) {
  const double left_n = std::max(0.0, left.load_n);
  const double right_n = std::max(0.0, right.load_n);
  Stance stance;
  stance.load_n = left_n + right_n;
  if (stance.load_n <= 0) return stance;
  stance.left_share = left_n / stance.load_n;
  double moment_nm = 0, load_n = 0;
  for (const FootLoad* foot : {&left, &right}) {
    if (!foot->cop_valid) continue;
    moment_nm += foot->load_n * foot->cop_x_m;
    load_n += foot->load_n;
  }
  if (load_n > 0) stance.forward_m = moment_nm / load_n;
  return stance;
}

void Weight::Advance(double load_n, double elapsed_s) {
  weighed_s_ = std::min(kWeighingS, weighed_s_ + elapsed_s);
  const double share = weighed_s_ > elapsed_s ? elapsed_s / weighed_s_ : 1;
  weight_n_ += share * (load_n - weight_n_);
}

}  // namespace footing::board
