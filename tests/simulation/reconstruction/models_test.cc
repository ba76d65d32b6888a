#include <gtest/gtest.h>

#include "tests/simulation/reconstruction/made_person.h"

namespace footing::reconstruction {
namespace {

TEST(Models, TheBasisOfAFileSpansItsPoses) {
  const body::Body person = MadePerson();
  const motion::Motion motion = MadeMotion(person, 12);
  const auto models = MakeModels({BasisOf(person, motion)});
  ASSERT_TRUE(models.ok()) << models.error().message;
  const pose::PoseBasis& basis = models->basis;
  for (Eigen::Index i = 0; i < motion.frames(); i += 50) {
    const Eigen::VectorXd a = basis.inverse * (motion.q.col(i) - basis.mean);
    EXPECT_LT((basis.mean + basis.modes * a - motion.q.col(i)).norm(), 1e-3);
  }
}

TEST(Models, SaysWhichFileIsWrongAndWhy) {
  const body::Body person = MadePerson();
  const NamedModel basis = BasisOf(person, MadeMotion(person, 10));
  const auto message = [](const std::vector<NamedModel>& models) {
    const auto made = MakeModels(models);
    return made.ok() ? std::string("fine") : made.error().message;
  };
  EXPECT_NE(message({}).find("footing-train basis"), std::string::npos);
  EXPECT_NE(message({basis, basis}).find("second model of kind basis"), std::string::npos);
  NamedModel other = basis;
  other.origin = "b.fmodel";
  other.model.kind = "mlp";
  EXPECT_NE(message({basis, other}).find("b.fmodel: a model of kind mlp"), std::string::npos);
  NamedModel cut = basis;
  cut.model.tensors.pop_back();
  EXPECT_NE(message({cut}).find("made.fmodel"), std::string::npos);
  NamedModel unscaled = basis;
  unscaled.model.tensors[1].values[5] = 0;
  EXPECT_NE(message({unscaled}).find("scale is not positive"), std::string::npos);
}

TEST(Models, ABodyOfAnotherLayoutIsRefusedByName) {
  const body::Body person = MadePerson();
  auto models = MakeModels({BasisOf(person, MadeMotion(person, 10))}).value();
  models.dofs[7] = "tail.x_rad";
  const auto created = Reconstruction::Create(person, models, {});
  ASSERT_FALSE(created.ok());
  EXPECT_NE(created.error().message.find("made.fmodel"), std::string::npos);
  EXPECT_NE(created.error().message.find(body::DofNames(person.skeleton)[7]), std::string::npos);
}

}  // namespace
}  // namespace footing::reconstruction
