#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "common/cli/cli.h"
#include "common/log/log.h"
#include "common/model/model.h"
#include "daemon/offline/eval/scores/pose_metrics.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/offline/train/poses.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::train {
namespace {

using nlohmann::ordered_json;

struct PeopleOptions {
  MotionOptions motions;
  std::vector<std::string> only;
  int every = 1;
  std::uint64_t seed = 1;
};

/// What is compared: all sensors, hands and feet with what is learned of these, and without.
enum Way { kBest, kLearned, kBare, kWays };
constexpr const char* kWayNames[kWays] = {"best", "hands_feet_learned", "hands_feet_ik"};

reconstruction::Options OptionsOf(Way way, double rate_hz) {
  reconstruction::Options options;
  options.rate_hz = rate_hz;
  options.use_momentum = way == kBest;
  options.use_posture = way != kBare;
  return options;
}

/// Sums over frames, all of them: those that are not valid count like the others.
struct Tally {
  double frames = 0, invalid = 0, nees = 0, nees_count = 0, height_m2 = 0;
  double posture_m2 = 0, posture_frames = 0;
  std::array<double, kWays> mpjpe_cm{};

  void Add(const Tally& other) {
    frames += other.frames;
    invalid += other.invalid;
    nees += other.nees;
    nees_count += other.nees_count;
    height_m2 += other.height_m2;
    posture_m2 += other.posture_m2;
    posture_frames += other.posture_frames;
    for (std::size_t i = 0; i < kWays; ++i) mpjpe_cm[i] += other.mpjpe_cm[i];
  }

  ordered_json Json() const {
    ordered_json json = {{"frames", frames}};
    for (std::size_t i = 0; i < kWays; ++i) {
      json[kWayNames[i]] = {{"mpjpe_cm", mpjpe_cm[i] / frames}};
    }
    json["gain_over_learned"] = 1 - mpjpe_cm[kBest] / mpjpe_cm[kLearned];
    json["invalid_share"] = invalid / frames;
    json["nees"] = nees / std::max(nees_count, 1.0);
    json["com_vertical_rms_cm"] = 100 * std::sqrt(height_m2 / frames);
    json["posture_com_vertical_rms_cm"] =
        100 * std::sqrt(posture_m2 / std::max(posture_frames, 1.0));
    return json;
  }
};

Result<Tally> ScoreTake(const PoseTake& take, const reconstruction::Models& models) {
  const auto run = SimulateTake(take);
  if (!run) return run.error();
  Tally tally;
  for (const Way way : {kBest, kLearned, kBare}) {
    auto made =
        reconstruction::Reconstruction::Create(run->body, models, OptionsOf(way, run->rate_hz));
    if (!made) return made.error();
    eval::PoseScore score(run->body);
    for (std::size_t i = 0; i < run->frames.size(); ++i) {
      const auto& output = made->Advance(run->frames[i].inputs);
      if (i < run->judged_from) continue;
      score.Add(output.q, run->frames[i].q);
      tally.mpjpe_cm[way] += score.last_mpjpe_cm();
      if (way != kBest) continue;
      ++tally.frames;
      tally.invalid += output.valid ? 0 : 1;
      tally.height_m2 += std::pow(output.com_W_m.z() - run->frames[i].com_m.z(), 2);
      if (output.posture_com_W_m) {
        ++tally.posture_frames;
        tally.posture_m2 += std::pow(output.posture_com_W_m->z() - run->frames[i].com_m.z(), 2);
      }
      for (std::size_t k = 0; k < output.joint_sd_m.size(); ++k) {
        tally.nees += score.errors_m()[k].squaredNorm() / (3 * std::pow(output.joint_sd_m[k], 2));
        ++tally.nees_count;
      }
    }
  }
  return tally;
}

/// "squat1Reps" of HDM_bd_squat1Reps_001_120.amc; else the file's name without its ending.
std::string ActivityOf(const Clip& clip) {
  std::string name = clip.name.substr(0, clip.name.rfind('.'));
  if (name.rfind("HDM_", 0) != 0) return name;
  name = name.substr(clip.subject.size() + 1);
  return name.substr(0, name.find('_'));
}

class LeaveOneOut {
 public:
  LeaveOneOut(std::vector<Clip> clips, std::uint64_t seed)
      : clips_(std::move(clips)), seed_(seed) {}

  /// What hands and feet show does not depend on who is left out.
  Result<void> Prepare() {
    for (const Clip& clip : clips_) all_.push_back(&clip);
    const auto basis = TrainBasis(clips_);
    if (!basis) return basis.error();
    model::Model model;
    model.kind = "basis";
    AppendBasis(basis->basis, model);
    const auto models = reconstruction::MakeModels({{"the basis", model}});
    if (!models) return models.error();
    int piece = 0;
    takes_ = TakesOf(all_, seed_, piece);
    for (const PoseTake& take : takes_) {
      postures_.emplace_back();
      const auto added = AddExamples(take, *models, learning::PoseCues::kPosture, postures_.back());
      if (!added) return added;
    }
    return {};
  }

  Result<reconstruction::Models> Train(const std::string& person) const {
    std::vector<Clip> others;
    for (const Clip& clip : clips_) {
      if (clip.subject != person) others.push_back(clip);
    }
    if (others.empty()) return UsageError("a single person: nobody to learn from");
    const auto basis = TrainBasis(others);
    if (!basis) return basis.error();
    model::Model model;
    model.kind = "basis";
    AppendBasis(basis->basis, model);
    learning::PoseExamples postures, examples;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      if (takes_[i].clip->subject == person) continue;
      const learning::PoseExamples& of = postures_[i];
      postures.features.insert(postures.features.end(), of.features.begin(), of.features.end());
      postures.poses.insert(postures.poses.end(), of.poses.begin(), of.poses.end());
      postures.folds.insert(postures.folds.end(), of.folds.begin(), of.folds.end());
    }
    AppendPoses(postures, learning::PoseCues::kPosture, basis->basis.scale, seed_, model);
    const auto first = reconstruction::MakeModels({{"the postures", model}});
    if (!first) return first.error();
    for (const PoseTake& take : takes_) {
      if (take.clip->subject == person) continue;
      const auto added = AddExamples(take, *first, learning::PoseCues::kMomentum, examples);
      if (!added) return added.error();
    }
    AppendPoses(examples, learning::PoseCues::kMomentum, basis->basis.scale, seed_, model);
    model.kind = "pose";
    return reconstruction::MakeModels({{"the model without " + person, model}});
  }

  /// Scores the person's clips in place; adds to `by_activity`.
  Result<Tally> ScorePerson(const std::string& person, const reconstruction::Models& models,
                            std::map<std::string, Tally>& by_activity) const {
    Tally sum;
    for (const PoseTake& take : takes_) {
      if (take.clip->subject != person || take.mirrored || !StaysInPlace(*take.clip)) continue;
      const auto tally = ScoreTake(take, models);
      if (!tally) return tally.error();
      sum.Add(*tally);
      by_activity[ActivityOf(*take.clip)].Add(*tally);
    }
    return sum;
  }

 private:
  std::vector<Clip> clips_;
  std::uint64_t seed_;
  std::vector<const Clip*> all_;
  std::vector<PoseTake> takes_;
  std::vector<learning::PoseExamples> postures_;  ///< Of each take.
};

int Run(const PeopleOptions& options, const Shared& shared) {
  auto clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  std::vector<Clip> kept;
  std::map<std::string, int> seen;
  for (Clip& clip : clips->train) {
    if (seen[clip.subject + ActivityOf(clip)]++ % options.every == 0)
      kept.push_back(std::move(clip));
  }
  std::set<std::string> people;
  for (const Clip& clip : kept) {
    if (StaysInPlace(clip)) people.insert(clip.subject);
  }
  if (people.empty()) return cli::Report(InvalidData("no motion in the folders stays in place"));
  std::set<std::string> only;
  for (const std::string& name : options.only) {
    only.insert(model::SubjectName(name));
    if (people.count(model::SubjectName(name)) == 0) {
      return cli::Report(UsageError("--only " + name +
                                    ": no motion of that subject that stays in place is there"));
    }
  }
  LeaveOneOut study(std::move(kept), options.seed);
  if (const auto prepared = study.Prepare(); !prepared) return cli::Report(prepared.error());
  ordered_json report;
  Tally sum;
  std::map<std::string, Tally> by_activity;
  for (const std::string& person : people) {
    if (!only.empty() && only.count(person) == 0) continue;
    const auto models = study.Train(person);
    if (!models) return cli::Report(models.error());
    const auto tally = study.ScorePerson(person, *models, by_activity);
    if (!tally) return cli::Report(tally.error());
    sum.Add(*tally);
    report["people"][person] = tally->Json();
    log::Info("scored " + person + ": " + tally->Json().dump());
  }
  for (const auto& [activity, tally] : by_activity) report["activities"][activity] = tally.Json();
  report["all"] = sum.Json();
  if (shared.json) {
    std::cout << report.dump() << "\n";
  } else {
    std::cout << report.dump(2) << "\n";
  }
  return 0;
}

}  // namespace

void AddPeopleCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PeopleOptions>();
  CLI::App* command = app.add_subcommand(
      "people",
      "Train pose models that leave one person out each, and evaluate them on this person");
  AddMotionOptions(*command, options->motions);
  command->add_option("--only", options->only,
                      "Person to leave out; may be repeated (default: all)");
  command
      ->add_option("--every", options->every,
                   "Take every so many of a person's takes of one activity")
      ->check(CLI::Range(1, 100));
  command->add_option("--seed", options->seed, "Seed of the simulated sensors and the model");
  command->footer(
      "Examples:\n"
      "  footing-train people --motions mocap/ --json\n"
      "  footing-train people --motions mocap/ --motions hdm05/ --only 14 --every 3");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
