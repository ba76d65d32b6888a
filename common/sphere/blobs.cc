#include "common/sphere/blobs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace footing::sphere {
namespace {

constexpr double kWidestHue = 0.577;  // tan 30 degrees.
constexpr int kUnit = 32;             // Of the integer weights.

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
void ScoreRow(const Quads& quads, int row, const HueWeights& w, std::int16_t* out) {
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(quads.width);
  const std::int16_t* red = quads.red.data() + first;
  const std::int16_t* green = quads.green.data() + first;
  const std::int16_t* blue = quads.blue.data() + first;
  for (int i = 0; i < quads.width; ++i) {
    const auto along = static_cast<std::int16_t>(w.along[0] * red[i] + w.along[1] * green[i] +
                                                 w.along[2] * blue[i]);
    const auto across = static_cast<std::int16_t>(w.across[0] * red[i] + w.across[1] * green[i] +
                                                  w.across[2] * blue[i]);
    const bool hit = along >= w.least && across <= along && across >= -along;
    out[i] = hit ? along : std::int16_t{0};
  }
}

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
  void AddRow(int row, const std::int16_t* scores, int width) {
    const std::size_t above = previous_;
    previous_ = runs_.size();
    for (int i = 0; i < width;) {
      std::uint64_t four = 0;
      if (i + 4 <= width) {
        std::memcpy(&four, scores + i, sizeof four);
        if (four == 0) {
          i += 4;
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
  int AddRun(int row, const std::int16_t* scores, int first, int width) {
    Run run{row, first, first, static_cast<int>(parents_.size()), 0, 0};
    int i = first;
    for (; i < width && scores[i] != 0; ++i) {
      run.score += scores[i];
      run.weighted += static_cast<double>(scores[i]) * i;
    }
    run.right = i - 1;
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

  std::vector<Run> runs_;
  std::vector<int> parents_;
  std::size_t previous_ = 0;
};

void MosaicRow(const Image& image, int row, std::int16_t* red, std::int16_t* green,
               std::int16_t* blue) {
  const std::uint8_t* upper = image.Row(2 * row);
  const std::uint8_t* lower = image.Row(2 * row + 1);
  for (int i = 0; i < image.width / 2; ++i) {
    red[i] = upper[2 * i + 1];
    green[i] = static_cast<std::int16_t>((upper[2 * i] + lower[2 * i + 1]) >> 1);
    blue[i] = lower[2 * i];
  }
}

void YuyvRow(const Image& image, int row, std::int16_t* red, std::int16_t* green,
             std::int16_t* blue) {
  const std::uint8_t* upper = image.Row(2 * row);
  const std::uint8_t* lower = image.Row(2 * row + 1);
  for (int i = 0; i < image.width / 2; ++i) {
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

void ToQuads(const Image& image, Quads& quads) {
  quads.width = image.width / 2;
  quads.height = image.height / 2;
  const auto size = static_cast<std::size_t>(quads.width) * static_cast<std::size_t>(quads.height);
  for (auto* plane : {&quads.red, &quads.green, &quads.blue}) plane->resize(size);
  for (int row = 0; row < quads.height; ++row) {
    const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(quads.width);
    const auto fill = image.format == PixelFormat::kSgrbg8 ? MosaicRow : YuyvRow;
    fill(image, row, quads.red.data() + first, quads.green.data() + first,
         quads.blue.data() + first);
  }
}

std::vector<Blob> FindBlobs(const Quads& quads, const Eigen::Vector3d& colour_dn, double share) {
  const HueWeights weights = WeightsOf(colour_dn, share);
  std::vector<std::int16_t> scores(static_cast<std::size_t>(quads.width));
  RunCollector runs;
  for (int row = 0; row < quads.height; ++row) {
    ScoreRow(quads, row, weights, scores.data());
    runs.AddRow(row, scores.data(), quads.width);
  }
  return runs.Blobs();
}

}  // namespace footing::sphere
