#include "common/camera/blobs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

// Loops over the whole image, in integers: the same on wider lanes, where a machine has them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define FOOTING_WIDE_LANES __attribute__((target_clones("avx2", "default")))
#else
#define FOOTING_WIDE_LANES
#endif

namespace footing::sphere {
namespace {

constexpr double kWidestHue = 0.577;  // tan 30 degrees.
constexpr double kColourOff = 0.25;   // Limb and gradient change a sphere's light by 0.15.
constexpr int kUnit = 32;             // Unit of the integer weights.

/// Chroma along a hue and across it as integer sums, DN times kUnit.
struct HueWeights {
  std::int16_t along[3], across[3];
  std::int16_t least;
};

HueWeights WeightsOf(const Eigen::Vector3d& colour, double share) {
  const Eigen::Vector3d chroma = colour.array() - colour.mean();
  const Eigen::Vector3d along = chroma.normalized();
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::Constant(1 / std::sqrt(3.0)));
  HueWeights weights{};
  for (int i = 0; i < 3; ++i) {
    weights.along[i] = static_cast<std::int16_t>(std::lround(kUnit * along[i]));
    weights.across[i] = static_cast<std::int16_t>(std::lround(kUnit / kWidestHue * across[i]));
  }
  // White must cancel in spite of the rounding.
  weights.along[1] = static_cast<std::int16_t>(-weights.along[0] - weights.along[2]);
  weights.across[1] = static_cast<std::int16_t>(-weights.across[0] - weights.across[2]);
  weights.least =
      static_cast<std::int16_t>(std::clamp(std::lround(kUnit * share * chroma.norm()), 1L, 16000L));
  return weights;
}

/// Chroma along the hue, or 0 where the hue is another one or the chroma too little.
FOOTING_WIDE_LANES void ScoreRow(const Quads& quads, int row, int left, int width,
                                 const HueWeights& w, std::int16_t* out) {
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(quads.width) +
                     static_cast<std::size_t>(left);
  const std::int16_t* red = quads.red.data() + first;
  const std::int16_t* green = quads.green.data() + first;
  const std::int16_t* blue = quads.blue.data() + first;
  for (int i = 0; i < width; ++i) {
    const auto along = static_cast<std::int16_t>(w.along[0] * red[i] + w.along[1] * green[i] +
                                                 w.along[2] * blue[i]);
    const auto across = static_cast<std::int16_t>(w.across[0] * red[i] + w.across[1] * green[i] +
                                                  w.across[2] * blue[i]);
    const bool hit = along >= w.least && across <= along && across >= -along;
    out[i] = hit ? along : std::int16_t{0};
  }
}

/// Which quads have a colour, within a share of its length.
class NearColour {
 public:
  explicit NearColour(const Eigen::Vector3d& colour) {
    for (int i = 0; i < 3; ++i) colour_[i] = static_cast<std::int16_t>(std::lround(colour[i]));
    most_ = static_cast<std::uint16_t>(
        std::min(kColourOff * kColourOff * colour.squaredNorm(), double{kFarthest * kFarthest}));
    const Eigen::Vector3d chroma = colour.array() - colour.mean();
    score_ = static_cast<std::int16_t>(std::clamp(std::lround(kUnit * chroma.norm()), 1L, 16000L));
  }

  FOOTING_WIDE_LANES void ScoreRow(const Quads& quads, int row, int left, int width,
                                   std::int16_t* out) const {
    const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(quads.width) +
                       static_cast<std::size_t>(left);
    const std::int16_t* red = quads.red.data() + first;
    const std::int16_t* green = quads.green.data() + first;
    const std::int16_t* blue = quads.blue.data() + first;
    for (int i = 0; i < width; ++i) {
      const auto sum = static_cast<std::uint16_t>(
          Square(red[i], colour_[0]) + Square(green[i], colour_[1]) + Square(blue[i], colour_[2]));
      out[i] = sum < most_ ? score_ : std::int16_t{0};
    }
  }

 private:
  // A difference beyond that is as far as that: three squares fit into 16 bits, eight at a time.
  static constexpr std::int16_t kFarthest = 127;

  static std::uint16_t Square(std::int16_t value, std::int16_t colour) {
    const auto apart = static_cast<std::int16_t>(value - colour);
    const std::int16_t bounded = std::min(kFarthest, std::max(apart, std::int16_t{-kFarthest}));
    return static_cast<std::uint16_t>(bounded * bounded);
  }

  std::int16_t colour_[3];
  std::uint16_t most_;
  std::int16_t score_;
};

/// Quads of one row side by side.
struct Run {
  int row, left, right, label;
  double score, weighted;
};

int RootOf(std::vector<int>& parents, int label) {
  while (parents[static_cast<std::size_t>(label)] != label) {
    int& parent = parents[static_cast<std::size_t>(label)];
    parent = parents[static_cast<std::size_t>(parent)];
    label = parent;
  }
  return label;
}

class RunCollector {
 public:
  /// Scores begin at that column.
  explicit RunCollector(int left) : left_(left) {}

  void AddRow(int row, const std::int16_t* scores, int width) {
    const std::size_t above = previous_;
    previous_ = runs_.size();
    for (int i = 0; i < width;) {
      if (i + kStride <= width) {
        std::array<std::uint64_t, kStride / 4> some;
        std::memcpy(some.data(), scores + i, sizeof some);
        if ((some[0] | some[1] | some[2] | some[3]) == 0) {
          i += kStride;
          continue;
        }
      }
      if (scores[i] == 0) {
        ++i;
        continue;
      }
      i = AddRun(row, scores, i, width);
    }
    Join(above);
  }

  std::vector<Blob> Blobs() {
    std::vector<Blob> blobs(parents_.size());
    for (const Run& run : runs_) {
      Blob& blob = blobs[static_cast<std::size_t>(RootOf(parents_, run.label))];
      const bool is_new = blob.area == 0;
      blob.left = is_new ? run.left : std::min(blob.left, run.left);
      blob.right = is_new ? run.right : std::max(blob.right, run.right);
      blob.top = is_new ? run.row : std::min(blob.top, run.row);
      blob.bottom = std::max(blob.bottom, run.row);
      blob.area += run.right - run.left + 1;
      blob.score += run.score;
      blob.centre += Eigen::Vector2d(run.weighted, run.score * run.row);
    }
    std::erase_if(blobs, [](const Blob& blob) { return blob.area < kLeastQuads; });
    for (Blob& blob : blobs) {
      blob.centre /= blob.score;
      blob.score /= kUnit;
    }
    return blobs;
  }

 private:
  static constexpr int kStride = 16;  // Quads that are skipped at once where nothing is.

  int AddRun(int row, const std::int16_t* scores, int first, int width) {
    Run run{row, left_ + first, left_ + first, static_cast<int>(parents_.size()), 0, 0};
    int i = first;
    for (; i < width && scores[i] != 0; ++i) {
      run.score += scores[i];
      run.weighted += static_cast<double>(scores[i]) * (left_ + i);
    }
    run.right = left_ + i - 1;
    runs_.push_back(run);
    parents_.push_back(run.label);
    return i;
  }

  /// Runs of this row with those of the row above that they touch, corners included.
  void Join(std::size_t above) {
    if (previous_ == runs_.size()) return;
    const int row = runs_.back().row;
    std::size_t up = above;
    for (std::size_t i = previous_; i < runs_.size(); ++i) {
      while (up < previous_ && (runs_[up].row != row - 1 || runs_[up].right < runs_[i].left - 1))
        ++up;
      for (std::size_t k = up; k < previous_ && runs_[k].left <= runs_[i].right + 1; ++k) {
        const int a = RootOf(parents_, runs_[k].label), b = RootOf(parents_, runs_[i].label);
        parents_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
    }
  }

  int left_;
  std::vector<Run> runs_;
  std::vector<int> parents_;
  std::size_t previous_ = 0;
};

FOOTING_WIDE_LANES void MosaicRow(const Image& image, int row, int left, int width,
                                  std::int16_t* red, std::int16_t* green, std::int16_t* blue) {
  const std::uint8_t* upper = image.Row(2 * row) + 2 * left;
  const std::uint8_t* lower = image.Row(2 * row + 1) + 2 * left;
  for (int i = 0; i < width; ++i) {
    red[i] = upper[2 * i + 1];
    green[i] = static_cast<std::int16_t>((upper[2 * i] + lower[2 * i + 1]) >> 1);
    blue[i] = lower[2 * i];
  }
}

void YuyvRow(const Image& image, int row, int left, int width, std::int16_t* red,
             std::int16_t* green, std::int16_t* blue) {
  const std::uint8_t* upper = image.Row(2 * row) + 4 * left;
  const std::uint8_t* lower = image.Row(2 * row + 1) + 4 * left;
  for (int i = 0; i < width; ++i) {
    const int luma = (upper[4 * i] + upper[4 * i + 2] + lower[4 * i] + lower[4 * i + 2]) >> 2;
    const int u = ((upper[4 * i + 1] + lower[4 * i + 1]) >> 1) - 128;
    const int v = ((upper[4 * i + 3] + lower[4 * i + 3]) >> 1) - 128;
    const auto clipped = [](int value) {
      return static_cast<std::int16_t>(std::clamp(value, 0, 255));
    };
    red[i] = clipped(luma + (359 * v >> 8));
    green[i] = clipped(luma - ((88 * u + 183 * v) >> 8));
    blue[i] = clipped(luma + (454 * u >> 8));
  }
}

}  // namespace

QuadWindow Whole(const Image& image) { return {0, 0, image.width / 2 - 1, image.height / 2 - 1}; }

QuadWindow Around(const Blob& blob, const Quads& quads, double margin_share) {
  const int size = std::max(blob.right - blob.left, blob.bottom - blob.top) + 1;
  const int margin = 2 + static_cast<int>(margin_share * size);
  return {std::max(0, blob.left - margin), std::max(0, blob.top - margin),
          std::min(quads.width - 1, blob.right + margin),
          std::min(quads.height - 1, blob.bottom + margin)};
}

void ToQuads(const Image& image, const QuadWindow& window, Quads& quads) {
  quads.width = image.width / 2;
  quads.height = image.height / 2;
  const auto size = static_cast<std::size_t>(quads.width) * static_cast<std::size_t>(quads.height);
  for (auto* plane : {&quads.red, &quads.green, &quads.blue}) plane->resize(size);
  const auto fill = image.format == PixelFormat::kSgrbg8 ? MosaicRow : YuyvRow;
  for (int row = window.top; row <= window.bottom; ++row) {
    const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(quads.width) +
                       static_cast<std::size_t>(window.left);
    fill(image, row, window.left, window.right - window.left + 1, quads.red.data() + first,
         quads.green.data() + first, quads.blue.data() + first);
  }
}

namespace {

/// Blobs of the scores of all rows.
template <typename Score>
std::vector<Blob> Collect(const QuadWindow& window, const Score& score) {
  const int width = window.right - window.left + 1;
  std::vector<std::int16_t> scores(static_cast<std::size_t>(width));
  RunCollector runs(window.left);
  for (int row = window.top; row <= window.bottom; ++row) {
    score(row, width, scores.data());
    runs.AddRow(row, scores.data(), width);
  }
  return runs.Blobs();
}

}  // namespace

std::vector<Blob> FindBlobs(const Quads& quads, const QuadWindow& window,
                            const Eigen::Vector3d& colour_dn, double share) {
  const HueWeights weights = WeightsOf(colour_dn, share);
  return Collect(window, [&](int row, int width, std::int16_t* scores) {
    ScoreRow(quads, row, window.left, width, weights, scores);
  });
}

std::vector<Blob> FindBlobsOfColour(const Quads& quads, const QuadWindow& window,
                                    const Eigen::Vector3d& colour_dn) {
  const NearColour near(colour_dn);
  return Collect(window, [&](int row, int width, std::int16_t* scores) {
    near.ScoreRow(quads, row, window.left, width, scores);
  });
}

}  // namespace footing::sphere
