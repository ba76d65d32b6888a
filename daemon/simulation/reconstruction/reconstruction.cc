#include "daemon/simulation/reconstruction/reconstruction.h"

#include <cmath>
#include <utility>

namespace footing::reconstruction {

Result<Reconstruction> Reconstruction::Create(const body::Body& body, const Models& models,
                                              const Options& options) {
  if (const auto checked = CheckOptions(options); !checked) return checked.error();
  const bool paper = options.mode == Mode::kPaper;
  auto made =
      paper ? PaperSubjectModel(body, models, options) : BestSubjectModel(body, models, options);
  if (!made) return made.error();
  const auto model = std::make_shared<const SubjectModel>(std::move(made).value());
  AnyMode mode = paper ? AnyMode(std::in_place_type<PaperMode>, *model, options)
                       : AnyMode(std::in_place_type<BestMode>, *model, options);
  return Reconstruction(model, std::move(mode), options);
}

Reconstruction::Reconstruction(std::shared_ptr<const SubjectModel> model, AnyMode mode,
                               const Options& options)
    : model_(std::move(model)), options_(options), mode_(std::move(mode)) {
  Recalibrate();
}

void Reconstruction::Recalibrate() {
  calibration_ = {};
  ReportTPose(*model_, options_, output_);
}

void Reconstruction::ContinueFrom(const Reconstruction& other) {
  if (!other.output_.calibrated) return;
  calibration_ = other.calibration_;
  output_ = other.output_;
  output_.lag_s = options_.lag_steps() * options_.step_s();
  std::visit([&](auto& mode) { mode.Start(calibration_.result()); }, mode_);
}

const Output& Reconstruction::Advance(const Inputs& inputs, const Truth& truth) {
  if (std::isfinite(inputs.loads.time_s)) output_.time_s = inputs.loads.time_s;
  if (output_.calibrated) {
    std::visit([&](auto& mode) { mode.Advance(inputs, truth, output_); }, mode_);
  } else if (Calibrate(inputs, options_.step_s(), calibration_, output_)) {
    std::visit([&](auto& mode) { mode.Start(calibration_.result()); }, mode_);
  }
  return output_;
}

}  // namespace footing::reconstruction
