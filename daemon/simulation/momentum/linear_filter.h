#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace footing::momentum {

/// A Kalman filter of N states that takes scalar measurements one after another, and remembers one
/// scalar of the state (a row `h`) as it was at the last kSlots steps: the fixed-lag smoother by
/// augmentation (Anderson & Moore 1979, "Optimal Filtering", section 7.3). A delayed scalar needs
/// its mean, its variance and its covariance with the present state only, so a lag costs
/// N² per slot and step, and no history of matrices. A plain value; nothing is allocated.
template <int N, int kSlots>
class LinearFilter {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Row = Eigen::Matrix<double, 1, N>;
  using Matrix = Eigen::Matrix<double, N, N>;
  struct Scalar {
    double mean = 0;
    double variance = 0;
  };

  void Start(const Vector& x, const Matrix& p) {
    x_ = x;
    p_ = p;
    count_ = 0;
  }

  /// Only the newest so many steps are remembered, at least one and at most kSlots: each costs
  /// time. Forgets all of them.
  void Keep(int steps) {
    kept_ = static_cast<std::size_t>(std::clamp(steps, 1, kSlots));
    count_ = 0;
  }

  /// x <- a x + u, P <- a P a' + q.
  void Predict(const Matrix& a, const Vector& u, const Matrix& q) {
    // Most states of most filters stay as they are: their rows of `a` are those of the identity.
    std::array<int, N> moved{};
    Matrix by_row;
    int count = 0;
    for (int i = 0; i < N; ++i) {
      if (a.row(i) == Row::Unit(i)) continue;
      by_row.col(count) = a.row(i).transpose();
      moved[static_cast<std::size_t>(count++)] = i;
    }
    const auto apply = [&](const auto& from, auto&& to) {
      for (int k = 0; k < count; ++k)
        to(moved[static_cast<std::size_t>(k)]) = by_row.col(k).dot(from);
    };
    apply(Vector(x_), x_);
    x_ += u;
    for (int column = 0; column < N; ++column) apply(Vector(p_.col(column)), p_.col(column));
    for (int row = 0; row < N; ++row) apply(Row(p_.row(row)), p_.row(row));
    p_ += q;
    Symmetrise();
    for (std::size_t i = 0; i < Used(); ++i) apply(Row(slots_[i].cross), slots_[i].cross);
  }

  /// Takes the measurement z = h x + noise of that variance (> 0). Returns the innovation's square
  /// over its variance.
  double Update(const Row& h, double z, double variance) {
    const double innovation = z - h * x_;
    const double s = (h * p_ * h.transpose())(0) + variance;
    Correct(h, innovation / s, 1 / s);
    return innovation * innovation / s;
  }

  /// Gives h x the new mean and variance by a density that is not a Gaussian's but is matched in
  /// its first two moments; the other states follow by their covariance.
  void SetMoments(const Row& h, const Scalar& posterior) {
    const double s = (h * p_ * h.transpose())(0);
    if (s <= 0) return;
    const double mean = h * x_;
    Correct(h, (posterior.mean - mean) / s, (s - posterior.variance) / (s * s));
  }

  /// Remembers h x + offset of this step as the newest slot.
  void Remember(const Row& h, double offset = 0) {
    Slot& slot = slots_[count_ % kept_];
    slot.mean = h * x_ + offset;
    slot.cross = h * p_;
    slot.variance = slot.cross * h.transpose();
    ++count_;
  }

  /// The remembered scalar of `steps` ago, given all measurements since (0: the newest one; more
  /// than there are: the oldest there is). At least one must have been remembered.
  Scalar Delayed(int steps) const {
    const std::size_t back = std::min<std::size_t>(static_cast<std::size_t>(steps), Used() - 1);
    const Slot& slot = slots_[(count_ - 1 - back) % kept_];
    return {slot.mean, slot.variance};
  }

  /// State i is no longer known: its mean is 0, with that variance.
  void Forget(int i, double variance) {
    x_(i) = 0;
    p_.row(i).setZero();
    p_.col(i).setZero();
    p_(i, i) = variance;
    for (std::size_t k = 0; k < Used(); ++k) slots_[k].cross(i) = 0;
  }

  /// This filter or another one that remembers the same steps, with weights `mine` and `theirs`
  /// (not negative, their sum positive): the first two moments of the mixture.
  void Merge(double mine, const LinearFilter& other, double theirs) {
    const double share = theirs / (mine + theirs);
    const Vector apart = other.x_ - x_;
    for (std::size_t k = 0; k < Used(); ++k) {
      Slot& slot = slots_[k];
      const Slot& from = other.slots_[k];
      const double off = from.mean - slot.mean;
      slot.cross +=
          share * (from.cross - slot.cross) + share * (1 - share) * off * apart.transpose();
      slot.variance += share * (from.variance - slot.variance) + share * (1 - share) * off * off;
      slot.mean += share * off;
    }
    p_ += share * (other.p_ - p_) + share * (1 - share) * apart * apart.transpose();
    x_ += share * apart;
    Symmetrise();
  }

  const Vector& x() const { return x_; }
  const Matrix& p() const { return p_; }
  Scalar Of(const Row& h) const { return {h * x_, (h * p_ * h.transpose())(0)}; }

 private:
  struct Slot {
    double mean = 0;
    double variance = 0;
    Row cross = Row::Zero();
  };

  std::size_t Used() const { return std::min(count_, kept_); }

  // x += P h' dx, P -= P h' h P dp, and the same for the slots.
  void Correct(const Row& h, double dx, double dp) {
    const Vector ph = p_ * h.transpose();
    for (std::size_t i = 0; i < Used(); ++i) {
      Slot& slot = slots_[i];
      const double ch = slot.cross * h.transpose();
      slot.mean += ch * dx;
      slot.variance = std::max(0.0, slot.variance - ch * ch * dp);
      slot.cross -= ch * dp * ph.transpose();
    }
    x_ += ph * dx;
    p_ -= dp * ph * ph.transpose();
    Symmetrise();
  }

  void Symmetrise() {
    p_ = (0.5 * (p_ + p_.transpose())).eval();
    for (int i = 0; i < N; ++i) p_(i, i) = std::max(p_(i, i), 1e-15);
  }

  Vector x_ = Vector::Zero();
  Matrix p_ = Matrix::Identity();
  std::size_t count_ = 0;
  std::size_t kept_ = kSlots;
  std::array<Slot, kSlots> slots_{};
};

/// Mean and variance of a scalar.
struct Moments {
  double mean = 0;
  double variance = 1;
};

/// A share of a mixture of normal densities.
struct Component {
  double share = 1;
  double mean = 0;
  double spread = 1;  ///< Standard deviation.
};

struct MixtureMoments {
  Moments moments;
  double log_evidence = 0;  ///< Log of the product's integral.
};

/// The first two moments of a normal density times a mixture of two, normalised. Finite for every
/// finite input with positive variances: far from both components the nearer one takes all.
MixtureMoments TimesMixture(const Moments& prior, const std::array<Component, 2>& mixture);

/// The first two moments of a normal density cut off above `limit`. Far above it the mass gathers
/// at the limit.
Moments Below(const Moments& prior, double limit);

/// How a posture that hands and feet alone make likely is wrong about the centre of mass, along one
/// axis: it shows `share` of the way, beside an error that is a first-order process and a white
/// one. A filter has the former as a state, so that no number of looks makes it smaller.
struct PostureError {
  double share = 1;
  double spread_m = 0;  ///< Standard deviation of the slow error; 0: postures are not asked.
  double time_s = 1;    ///< Its correlation time.
  double white_m = 0.01;
};

}  // namespace footing::momentum
