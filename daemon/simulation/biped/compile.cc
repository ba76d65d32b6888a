#include "daemon/simulation/biped/compile.h"

#include <array>
#include <cstring>

namespace footing::physics {
namespace {

void IgnoreWarning(const char*) {}
void AbortOnError(const char* message) { CheckFailed(message, "MuJoCo", 0); }

/// Once, since they are globals of MuJoCo and worlds are compiled on several threads.
void TakeItsMessages() {
  [[maybe_unused]] static const bool taken = [] {
    mju_user_warning = IgnoreWarning;
    mju_user_error = AbortOnError;
    return true;
  }();
}

struct DeleteVfs {
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};

}  // namespace

Result<ModelPointer> Compile(const std::string& mjcf) {
  TakeItsMessages();
  const char* name = "world.xml";
  std::unique_ptr<mjVFS, DeleteVfs> files(new mjVFS);
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());

  std::array<char, 1000> reason{};
  ModelPointer model(mj_loadXML(name, files.get(), reason.data(), static_cast<int>(reason.size())));
  if (!model) {
    return InvalidData(std::string("the world does not compile: ") + reason.data() +
                       "; check the numbers of the biped's and the track's file");
  }
  return model;
}

Result<int> IdOf(const mjModel& model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(&model, type, name.c_str());
  if (id < 0) return InvalidData("the world has no \"" + name + "\"; check the MJCF writer");
  return id;
}

}  // namespace footing::physics
