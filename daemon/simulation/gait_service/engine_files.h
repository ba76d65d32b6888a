#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/simulation/engine/engine.h"

namespace footing::engine_files {

struct Wish {
  std::string track = "plain";  ///< Name of a built-in track, or a path.
  stream::UserInterface interface = stream::UserInterface::kWrist;
  std::string mapping_table = "";  ///< Path of the interface's table; empty: the built-in one.
  std::string data_folder = "";  ///< Where the built-in files are; empty: where FindDataFile looks.
  /// Gain tables to read after the built-in ones; a later one replaces what an earlier one had for
  /// its gaits.
  std::vector<std::string> more_gains = {};
};

/// The texts of the files that the engine runs on. Fails with one line that names the file.
Result<engine::EngineTexts> ReadTexts(const Wish& wish = {});

/// An interface with its built-in table. Fails with one line that names the file.
Result<mapping::AnyInterface> ReadInterface(const mapping::InterfaceOptions& options,
                                            const std::string& data_folder = "");

}  // namespace footing::engine_files
