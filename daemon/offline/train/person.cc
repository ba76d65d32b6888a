#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/body/kinematics.h"
#include "common/cli/cli.h"
#include "common/model/model.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/wire/model_file.h"
#include "daemon/offline/learning/person_fit.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/person_recording.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::train {
namespace {

constexpr double kPersonPieceS = 5;  // Frames of one piece are held out together.
constexpr double kPersonNoiseKg = 0.05;
constexpr double kEnoughPersonS = 60;

struct PersonOptions {
  std::string base;
  std::string subject;
  std::vector<std::string> recordings;
  std::vector<std::string> motions;
  std::string skeleton;
  std::vector<std::string> sensors{"sphere", "pelvis", "thighs"};
  ModelOptions model;
};

/// Sensors that show the pose of a simulated take beside boards and hands.
struct RicherSensors {
  bool truth = false, skeleton = false;
  pose_run::HeadDevice head = pose_run::HeadDevice::kNone;
  std::vector<reconstruction::BodySite> segments;
};

Result<void> AddSegments(const std::string& name, std::vector<reconstruction::BodySite>& segments) {
  const std::size_t before = segments.size();
  for (std::size_t site = 0; site < reconstruction::kBodySites; ++site) {
    const std::string known = reconstruction::kBodySiteNames[site];
    const std::size_t side = known.find('_');
    const bool both = side != std::string::npos && known.substr(side + 1) + "s" == name;
    if (known == name || both) segments.push_back(static_cast<reconstruction::BodySite>(site));
  }
  if (segments.size() > before) return {};
  return UsageError("--sensors " + name +
                    ": must be sphere, kinect, truth, pelvis, chest, head, thighs, shanks, or one "
                    "of a side such as left_thigh");
}

Result<RicherSensors> SensorsNamed(const std::vector<std::string>& names) {
  RicherSensors sensors;
  for (const std::string& name : names) {
    if (name == "truth") {
      sensors.truth = true;
    } else if (name == "sphere") {
      sensors.head = pose_run::HeadDevice::kSphere;
    } else if (name == "kinect") {
      sensors.skeleton = true;
    } else if (const auto added = AddSegments(name, sensors.segments); !added) {
      return added.error();
    }
  }
  if (sensors.skeleton && sensors.head != pose_run::HeadDevice::kNone) {
    return UsageError("--sensors: a kinect sees the head; give sphere or kinect");
  }
  return sensors;
}

/// Sums over the frames, for the report.
struct PersonTally {
  double seconds = 0;
  double error_cm = 0, joints = 0;  ///< Errors of the better known pose, where the truth is known.
};

/// One simulated take, twice: under boards and hands, and with the richer sensors beside them.
Result<void> AddTake(const Clip& clip, const RicherSensors& sensors,
                     const reconstruction::Models& models, std::uint64_t seed, int& piece,
                     learning::PersonExamples& examples, PersonTally& tally) {
  pose_run::Settings settings;
  settings.errors.noise_kg = kPersonNoiseKg;
  settings.errors.seed = settings.seed = seed;
  const auto plain_run = pose_run::RunPose(clip.motion, settings, clip.name);
  if (!plain_run) return plain_run.error();
  settings.head = sensors.head;
  settings.segments = sensors.segments;
  settings.joints = sensors.skeleton;
  if (sensors.skeleton) settings.hand_device = pose_run::HandDevice::kKinect;
  const auto rich_run = pose_run::RunPose(clip.motion, settings, clip.name);
  if (!rich_run) return rich_run.error();
  reconstruction::Options options;
  options.rate_hz = plain_run->rate_hz;
  auto plain = reconstruction::Reconstruction::Create(plain_run->body, models, options);
  if (!plain) return plain.error();
  auto rich = reconstruction::Reconstruction::Create(rich_run->body, models, options);
  if (!rich) return rich.error();
  const auto first = plain_run->judged_from + static_cast<std::size_t>(kSettledS * options.rate_hz);
  const auto piece_frames = static_cast<std::size_t>(kPersonPieceS * options.rate_hz);
  body::Kinematics at(plain_run->body.skeleton), true_at(plain_run->body.skeleton);
  int last = 0;
  for (std::size_t i = 0; i < plain_run->frames.size(); ++i) {
    const pose_run::Frame& frame = plain_run->frames[i];
    plain->Advance(frame.inputs);
    const auto& output = rich->Advance(rich_run->frames[i].inputs);
    if (i < first || !plain->output().calibrated || !output.calibrated) continue;
    if (!sensors.truth && !output.valid) continue;
    const Eigen::VectorXd& q = sensors.truth ? frame.q : output.q;
    last = static_cast<int>((i - first) / piece_frames);
    examples.Add(*plain, q, piece + last);
    tally.seconds += 1 / options.rate_hz;
    body::ComputeKinematics(plain_run->body.skeleton, q, at);
    body::ComputeKinematics(plain_run->body.skeleton, frame.q, true_at);
    for (std::size_t k = 0; k < at.p_WJ.size(); ++k) {
      tally.error_cm += 100 * (at.p_WJ[k] - true_at.p_WJ[k]).norm();
      ++tally.joints;
    }
  }
  piece += last + 1;
  return {};
}

/// All that is known of the person.
struct PersonData {
  std::string subject;
  std::vector<model::DataFile> files;
  learning::PersonExamples examples;
  PersonTally tally;
};

Result<void> AddMotions(const PersonOptions& options, const reconstruction::Models& models,
                        PersonData& data) {
  const auto sensors = SensorsNamed(options.sensors);
  if (!sensors) return sensors.error();
  int piece = 0;
  std::uint64_t seed = options.model.seed;
  for (const std::string& motion : options.motions) {
    auto clip = ReadClip(motion, options.skeleton);
    if (!clip) return clip.error();
    if (const auto fitted = FitToStandardLayout(*clip); !fitted) return fitted.error();
    if (data.subject.empty()) data.subject = clip->subject;
    data.files.push_back(clip->file);
    const auto added =
        AddTake(*clip, *sensors, models, seed += 100, piece, data.examples, data.tally);
    if (!added) return added;
  }
  return {};
}

Result<void> AddRecordings(const PersonOptions& options, const reconstruction::Models& models,
                           PersonData& data) {
  for (const std::string& path : options.recordings) {
    const auto recording = ReadPersonRecording(path, data.subject);
    if (!recording) return recording.error();
    data.subject = recording->subject.code;
    data.files.push_back(recording->file);
    const auto added = AddPersonRecording(*recording, models, data.examples);
    if (!added) return added.error();
    data.tally.seconds += *added;
  }
  return {};
}

Result<PersonData> Gather(const PersonOptions& options, const reconstruction::Models& models) {
  if (options.recordings.empty() == options.motions.empty()) {
    return UsageError("give either --recording of the person, or --motion for simulated sensors");
  }
  PersonData data;
  data.subject = options.subject;
  const auto added = options.motions.empty() ? AddRecordings(options, models, data)
                                             : AddMotions(options, models, data);
  if (!added) return added.error();
  if (data.examples.size() == 0) return InvalidData("no frame with a valid pose to adapt to");
  if (data.tally.seconds < kEnoughPersonS) {
    log::Warning("only " + std::to_string(std::lround(data.tally.seconds)) +
                 " s of valid frames; two minutes are better");
  }
  return data;
}

Result<reconstruction::NamedModel> ReadBase(const std::string& given) {
  std::string path = given;
  if (path.empty()) {
    const auto found = config::FindDataFile("pose.fmodel");
    if (!found) return found.error();
    path = *found;
  }
  const auto bytes = config::ReadTextFile(path, model::kMostFileBytes);
  if (!bytes) return bytes.error();
  auto model = wire::FromModelFile(*bytes, path);
  if (!model) return model.error();
  if (const auto kind = model::CheckKind(*model, "pose", path); !kind) return kind.error();
  return reconstruction::NamedModel{path, std::move(*model)};
}

nlohmann::ordered_json ToJson(const learning::FittedCorrection& fitted) {
  using nlohmann::ordered_json;
  return {{"left_out_error_before", fitted.error_base},
          {"left_out_error", fitted.error},
          {"penalty_frames",
           std::isfinite(fitted.penalty) ? ordered_json(fitted.penalty) : ordered_json(nullptr)}};
}

int Run(const PersonOptions& options, const Shared& shared) {
  if (auto free = CheckFree(options.model); !free) return cli::Report(free.error());
  const auto base = ReadBase(options.base);
  if (!base) return cli::Report(base.error());
  const auto models = reconstruction::MakeModels({*base});
  if (!models) return cli::Report(models.error());
  if (models->posture.empty()) {
    return cli::Report(InvalidData(base->origin + ": has no posture; train it again"));
  }
  auto data = Gather(options, *models);
  if (!data) return cli::Report(data.error());
  const auto likely =
      learning::FitCorrection(data->examples.likely, models->regression, models->rest);
  const auto posture = learning::FitCorrection(data->examples.posture, models->posture.regression,
                                               models->posture.rest);
  auto files = std::move(data->files);
  files.insert(files.begin(),
               {.name = "pose.fmodel", .sha256 = reconstruction::BaseDigest(base->model)});
  model::Model model = NewModel("person", shared, options.model, std::move(files), {data->subject});
  learning::AppendTensors(likely.correction, "", model);
  learning::AppendTensors(posture.correction, reconstruction::kPosturePrefix, model);
  nlohmann::ordered_json report = {{"subject", data->subject},
                                   {"seconds", data->tally.seconds},
                                   {"likely", ToJson(likely)},
                                   {"posture", ToJson(posture)}};
  if (data->tally.joints > 0) {
    report["reference_error_cm"] = data->tally.error_cm / data->tally.joints;
  }
  return Deliver(model, options.model, report, shared);
}

}  // namespace

void AddPersonCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PersonOptions>();
  CLI::App* command = app.add_subcommand(
      "person", "Person's model: what a person's own motion changes of a pose model");
  command->add_option("--recording", options->recordings,
                      "Recording of footing-sim with more sensors than boards and hands, MCAP; may "
                      "be repeated");
  command->add_option("--motion", options->motions,
                      "In its place, a motion under simulated sensors; may be repeated");
  command->add_option("--skeleton", options->skeleton, "Skeleton of the AMC motions, ASF file");
  command
      ->add_option("--sensors", options->sensors,
                   "Simulated sensors beside boards and hands: sphere, kinect, pelvis, chest, "
                   "head, thighs, shanks, or truth (default sphere,pelvis,thighs)")
      ->delimiter(',');
  command->add_option("--base", options->base, "Pose model that is adapted (default: built in)");
  command->add_option("--subject", options->subject,
                      "Code of the person (default: the last of the recording)");
  AddModelOptions(*command, options->model);
  command->footer(
      "Examples:\n"
      "  footing-ctl motions --out p07.mcap\n"
      "  footing-train person --recording p07.mcap --subject p07 --out p07.fmodel\n"
      "  footing-train person --motion 13_29.amc --motion 13_30.amc --out 13.fmodel --json");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
