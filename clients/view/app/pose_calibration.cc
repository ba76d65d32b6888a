#include "clients/view/app/pose_calibration.h"

#include <utility>

#include "common/runtime/clock.h"
#include "common/frames/camera_file.h"
#include "common/base/utc.h"
#include "common/wire/wire.h"

namespace footing::view {
namespace {

v1::Command RecordCommand(const std::string& rig, stream::SetupItem item) {
  item.wall_time_ns = clock::WallNs();
  v1::Command command;
  command.mutable_record_setup()->set_rig(rig);
  *command.mutable_record_setup()->mutable_item() = wire::ToProto(item);
  return command;
}

}  // namespace

Result<PoseCalibration> PoseCalibration::Open(const std::string& camera_file) {
  const auto camera = frames::ReadCameraFile(camera_file);
  if (!camera) return camera.error();
  guide::SetUpOptions options;
  options.camera_file = camera_file;
  options.camera_role = camera->spheres.front().role;
  options.camera_radius_m = camera->spheres.front().target.radius_m;
  options.tries = 1;  // A refusal is read first; then the person begins again.
  return PoseCalibration(std::move(options));
}

Result<std::optional<PoseCalibration>> PoseCalibration::OfOptions(const std::string& camera_file) {
  if (camera_file.empty()) return std::optional<PoseCalibration>();
  auto opened = Open(camera_file);
  if (!opened) return opened.error();
  opened->Begin();
  return std::optional<PoseCalibration>(std::move(opened).value());
}

void PoseCalibration::Begin() {
  set_up_.emplace(options_, std::vector<guide::Item>{guide::Item::kCamera});
  answers_.clear();
  shown_ = {};
  shown_.rig = options_.rig;
  shown_.file = options_.camera_file;
}

void PoseCalibration::End() { set_up_.reset(); }

void PoseCalibration::Take(const scene::Update& update) {
  if (update.host_ns != 0) now_ns_ = update.host_ns;
  if (update.devices) recent_.SetDevices(*update.devices);
  for (const auto& sample : update.motion) recent_.Add(sample);
  for (const auto& sample : update.boards) recent_.Add(sample);
  for (const auto& sample : update.hands) recent_.Add(sample);
}

guide::Answer PoseCalibration::Store(const guide::Action& action) const {
  constexpr std::size_t kDateLength = 10;  // Of ISO 8601.
  const std::string date = text::Utc(clock::WallNs()).substr(0, kDateLength);
  const auto stored =
      frames::StorePose(options_.camera_file, action.X_WC, date + ": " + action.remark);
  guide::Answer answer;
  answer.key = action.key;
  answer.ok = stored.ok();
  answer.message =
      stored ? action.remark + "; stored in " + options_.camera_file : stored.error().message;
  return answer;
}

void PoseCalibration::TakeProgress(guide::Progress progress) {
  shown_.prompt = std::move(progress.prompt);
  shown_.feedback = std::move(progress.feedback);
  if (progress.marks) shown_.marks = std::move(progress.marks);
  for (const guide::Action& action : progress.actions)
    if (action.kind == guide::Action::Kind::kStoreCamera) answers_.push_back(Store(action));
}

void PoseCalibration::Advance(scene::Model& model, const std::function<void(v1::Command)>& record) {
  if (!set_up_) {
    model.observed.calibration.reset();
    return;
  }
  // Without a newer tick nothing can have happened.
  if (!shown_.result && now_ns_ != std::exchange(advanced_ns_, now_ns_)) {
    guide::Situation now;
    now.now_ns = now_ns_;
    now.recent = &recent_;
    now.setup = &model.setup;
    now.answers = std::exchange(answers_, {});
    guide::Progress progress = set_up_->Advance(now);
    TakeProgress(std::move(progress));
    if (!set_up_->results().empty()) {
      shown_.result = set_up_->results().back();
      record(RecordCommand(options_.rig, *shown_.result));
    }
  }
  model.observed.calibration = shown_;
}

}  // namespace footing::view
