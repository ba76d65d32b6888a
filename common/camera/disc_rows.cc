#include "common/camera/disc_rows.h"

namespace footing::sphere::disc {

std::vector<Sample> Thinned(const std::vector<Sample>& all, std::size_t most) {
  const std::size_t every = 1 + all.size() / most;
  std::vector<Sample> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 4 % every == 0) some.push_back(all[i]);
  return some;
}

void ToBlocks(const std::vector<Sample>& samples, std::vector<Block>& blocks) {
  blocks.clear();
  std::array<std::size_t, 3> open{};  // Number of the channel's block, and one.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    const auto channel = static_cast<std::size_t>(sample.channel);
    if (open[channel] == 0 || blocks[open[channel] - 1].count == kBlock) {
      Block& block = blocks.emplace_back();
      block.channel = channel;
      for (Lane* lane :
           {&block.s, &block.t, &block.later, &block.value, &block.behind, &block.is_used})
        lane->setZero();
      open[channel] = blocks.size();
    }
    Block& block = blocks[open[channel] - 1];
    const int k = block.count++;
    block.samples[static_cast<std::size_t>(k)] = i;
    block.s[k] = static_cast<float>(sample.slopes.x());
    block.t[k] = static_cast<float>(sample.slopes.y());
    block.later[k] = static_cast<float>(sample.later);
    block.value[k] = static_cast<float>(sample.value);
    block.behind[k] = static_cast<float>(sample.behind);
    block.is_used[k] = 1;
  }
}

void ToSamples(const std::vector<Block>& blocks, std::vector<Sample>& samples) {
  for (const Block& block : blocks) {
    for (int k = 0; k < block.count; ++k) {
      Sample& sample = samples[block.samples[static_cast<std::size_t>(k)]];
      sample.beyond = static_cast<double>(block.beyond[k]);
      sample.residual = static_cast<double>(block.residual[k]);
      sample.height = static_cast<double>(block.height[k]);
    }
  }
}

Lane AfterAxis(const Block& block, const State& state, const PixelScale& scale) {
  return block.later - static_cast<float>(scale.down().dot(state.shape.head<2>()));
}

template <int kSize>
void ToRows(Block& block, const State& state, const PixelNoise& noise, const PixelScale& scale,
            const ProfileTable& table, Rows<kSize>& rows) {
  constexpr bool kMoves = kSize == kOwnMoving;
  std::conditional_t<kMoves, ModelledMoving, Modelled> model;
  if constexpr (kMoves) {
    ModelMoving(block.s, block.t, AfterAxis(block, state, scale), state, scale, table, model);
  } else {
    Model(block.s, block.t, state, scale, table, model);
  }
  const auto inside = static_cast<float>(state.inside[block.channel]);
  const Lane outside = static_cast<float>(state.outside[block.channel]) + block.behind;
  for (std::size_t i = 0; i < kShape; ++i) rows.row[i] = inside * model.light_slope[i];
  for (std::size_t i = 0; i < 4; ++i) rows.row[i] -= outside * model.cover_slope[i];
  if constexpr (kMoves) {
    for (std::size_t i = 0; i < kMotion; ++i)
      rows.row[kShape + i] = inside * model.light_motion[i] - outside * model.cover_motion[i];
  }
  rows.row[kSize - 2] = model.light;
  rows.row[kSize - 1] = 1 - model.cover;
  rows.modelled = outside * rows.row[kSize - 1] + inside * model.light;
  rows.off = block.value - rows.modelled;
  const auto dark = static_cast<float>(noise.DarkVariance());
  const Lane per_variance =
      1 / (dark + static_cast<float>(noise.dn_per_electron) * rows.modelled.max(0.0F));
  const Lane per_sd = per_variance.sqrt();
  block.beyond = model.beyond;
  block.residual = rows.off * per_sd;
  block.height = (inside - outside).abs() * per_sd;
  constexpr auto kHuberSds = static_cast<float>(kHuber);
  const Lane z = block.residual.abs(), bounded = z.min(kHuberSds);
  rows.cost = block.is_used * bounded * (2 * z - bounded);
  rows.weight = block.is_used * per_variance * kHuberSds / z.max(kHuberSds);
}

template <int kSize>
void Equations<kSize>::Add(const Rows<kSize>& rows, std::size_t channel) {
  Part& part = per_channel_[channel];
  Row& right = right_[channel];
  for (int i = 0; i < kSize; ++i) {
    const Lane weighted = rows.weight * rows.row[static_cast<std::size_t>(i)];
    right[i] += static_cast<double>((weighted * rows.off).sum());
    for (int j = i; j < kSize; ++j)
      part(i, j) += static_cast<double>((weighted * rows.row[static_cast<std::size_t>(j)]).sum());
  }
}

template <int kSize>
void Equations<kSize>::Assemble(Normal& normal, Right& right) const {
  constexpr int kHead = kSize - 2;
  normal.setZero();
  right.setZero();
  for (int c = 0; c < 3; ++c) {
    const Part part =
        per_channel_[static_cast<std::size_t>(c)].template selfadjointView<Eigen::Upper>();
    const auto& part_right = right_[static_cast<std::size_t>(c)];
    const int own = kLevels + 2 * c;
    normal.template topLeftCorner<kHead, kHead>() += part.template topLeftCorner<kHead, kHead>();
    normal.template block<kHead, 2>(0, own) = part.template topRightCorner<kHead, 2>();
    normal.template block<2, kHead>(own, 0) = part.template bottomLeftCorner<2, kHead>();
    normal.template block<2, 2>(own, own) = part.template bottomRightCorner<2, 2>();
    right.template head<kHead>() += part_right.template head<kHead>();
    right.template segment<2>(own) = part_right.template tail<2>();
  }
  for (int i = 0; i < kParameters; ++i)
    if (normal(i, i) <= 0) normal(i, i) = 1;
}

template struct Rows<kOwn>;
template struct Rows<kOwnMoving>;
template class Equations<kOwn>;
template class Equations<kOwnMoving>;
template void ToRows(Block&, const State&, const PixelNoise&, const PixelScale&,
                     const ProfileTable&, Rows<kOwn>&);
template void ToRows(Block&, const State&, const PixelNoise&, const PixelScale&,
                     const ProfileTable&, Rows<kOwnMoving>&);

}  // namespace footing::sphere::disc
