#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "common/cli/cli.h"
#include "common/runtime/log.h"
#include "common/model/model.h"
#include "common/base/json_text.h"
#include "daemon/offline/compute/ranks.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/motions.h"
#include "daemon/offline/train/people_score.h"
#include "daemon/offline/train/pose_training.h"
#include "daemon/offline/train/poses.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::train {
namespace {

using nlohmann::ordered_json;

struct PeopleOptions {
  MotionOptions motions;
  std::vector<std::string> only;
  int every = 1;
  MoreWays more;
  std::uint64_t seed = 1;
};

/// "squat1Reps" of HDM_bd_squat1Reps_001_120.amc; else the file's name without its ending.
std::string ActivityOf(const Clip& clip) {
  std::string name = clip.name.substr(0, clip.name.rfind('.'));
  if (name.rfind("HDM_", 0) != 0) return name;
  name = name.substr(clip.subject.size() + 1);
  return name.substr(0, name.find('_'));
}

/// What one take came to; plain, since ranks share it.
struct ScoredTake {
  std::size_t take = 0;
  PoseTally tally;
};

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
      postures.Append(postures_[i]);
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

  /// Scores the person's clips in place, and appends each to `scored`.
  Result<PoseTally> ScorePerson(const std::string& person, const reconstruction::Models& models,
                                const MoreWays& more, std::vector<ScoredTake>& scored) const {
    PoseTally sum;
    for (std::size_t i = 0; i < takes_.size(); ++i) {
      const PoseTake& take = takes_[i];
      if (take.clip->subject != person || take.mirrored || !StaysInPlace(*take.clip)) continue;
      const auto tally = ScoreTake(take, models, more);
      if (!tally) return tally.error();
      sum.Add(*tally);
      scored.push_back({i, *tally});
    }
    return sum;
  }

  const Clip& ClipOf(const ScoredTake& scored) const { return *takes_[scored.take].clip; }

 private:
  std::vector<Clip> clips_;
  std::uint64_t seed_;
  std::vector<const Clip*> all_;
  std::vector<PoseTake> takes_;
  std::vector<learning::PoseExamples> postures_;  ///< Of each take.
};

/// Of each activity of a person so many takes as the options say.
std::vector<Clip> Thinned(std::vector<Clip> clips, int every) {
  std::vector<Clip> kept;
  std::map<std::string, int> seen;
  for (Clip& clip : clips) {
    if (seen[clip.subject + ActivityOf(clip)]++ % every == 0) kept.push_back(std::move(clip));
  }
  return kept;
}

/// The people to leave out, one after the other.
Result<std::vector<std::string>> PeopleOf(const std::vector<Clip>& clips,
                                          const std::vector<std::string>& only) {
  std::set<std::string> people;
  for (const Clip& clip : clips) {
    if (StaysInPlace(clip)) people.insert(clip.subject);
  }
  if (people.empty()) return InvalidData("no motion in the folders stays in place");
  if (only.empty()) return std::vector(people.begin(), people.end());
  std::set<std::string> asked;
  for (const std::string& name : only) {
    asked.insert(model::SubjectName(name));
    if (people.count(model::SubjectName(name)) == 0) {
      return UsageError("--only " + name +
                        ": no motion of that subject that stays in place is there; there are " +
                        Listed(people));
    }
  }
  return std::vector(asked.begin(), asked.end());
}

/// This rank's share of the people, take by take.
Result<std::vector<ScoredTake>> ScoreOwn(const LeaveOneOut& study,
                                         const std::vector<std::string>& people,
                                         const MoreWays& more, const ranks::Ranks& ranks) {
  std::vector<ScoredTake> scored;
  for (std::size_t i = ranks.rank(); i < people.size(); i += ranks.count()) {
    const auto models = study.Train(people[i]);
    if (!models) return models.error();
    const auto tally = study.ScorePerson(people[i], *models, more, scored);
    if (!tally) return tally.error();
    log::Info("scored " + people[i] + ": " + tally->Json().dump());
  }
  return scored;
}

/// The sums, added up person after person and take after take, whoever scored them.
ordered_json ReportOf(const LeaveOneOut& study, const std::vector<std::string>& people,
                      const std::vector<std::vector<ScoredTake>>& by_rank) {
  ordered_json report;
  PoseTally sum;
  std::map<std::string, PoseTally> by_activity;
  for (std::size_t i = 0; i < people.size(); ++i) {
    PoseTally of_person;
    for (const ScoredTake& scored : by_rank[i % by_rank.size()]) {
      if (study.ClipOf(scored).subject != people[i]) continue;
      of_person.Add(scored.tally);
      by_activity[ActivityOf(study.ClipOf(scored))].Add(scored.tally);
    }
    of_person.AboutPerson();
    sum.Add(of_person);
    report["people"][people[i]] = of_person.Json();
  }
  for (const auto& [activity, tally] : by_activity) report["activities"][activity] = tally.Json();
  report["all"] = sum.Json();
  return report;
}

int Run(const PeopleOptions& options, const Shared& shared) {
  auto clips = ReadClips(options.motions);
  if (!clips) return cli::Report(clips.error());
  std::vector<Clip> kept = Thinned(std::move(clips->train), options.every);
  const auto people = PeopleOf(kept, options.only);
  if (!people) return cli::Report(people.error());
  LeaveOneOut study(std::move(kept), options.seed);
  if (const auto prepared = study.Prepare(); !prepared) return cli::Report(prepared.error());
  const auto scored = ScoreOwn(study, *people, options.more, shared.ranks);
  if (!scored) return cli::Report(scored.error());
  const ordered_json report = ReportOf(study, *people, shared.ranks.Share(*scored));
  if (shared.ranks.first()) std::cout << text::ToText(report, shared.json ? -1 : 2) << "\n";
  return 0;
}

}  // namespace

void AddPeopleCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<PeopleOptions>();
  CLI::App* command = app.add_subcommand(
      "people",
      "Train pose models that leave one person out each, and evaluate them on this person");
  AddMotionOptions(*command, options->motions);
  command->get_option("--motions")->required();
  command->add_option("--only", options->only,
                      "Person to leave out; may be repeated (default: all)");
  command
      ->add_option("--every", options->every, "Use every Nth of a person's takes of one activity")
      ->check(CLI::Range(1, 100));
  command->add_flag("--ablations", options->more.truth,
                    "Score with true COM, momentum, feet and all of them, too");
  command->add_flag("--sensors", options->more.sensors,
                    "Score with a tracker of the head, a belt and both, too");
  command->add_option("--seed", options->seed, "Seed of the simulated sensors and the model");
  command->footer(
      "Examples:\n"
      "  footing-train people --motions mocap/ --json\n"
      "  footing-train people --motions mocap/ --motions hdm05/ --only 14 --every 3\n"
      "  footing-train people --motions mocap/ --ablations\n"
      "  footing-train people --motions mocap/ --every 3 --sensors --json\n"
      "  mpirun -n 4 footing-train people --motions mocap/ --json");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train
