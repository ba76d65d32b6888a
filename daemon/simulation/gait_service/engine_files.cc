#include "daemon/simulation/gait_service/engine_files.h"

#include <utility>

#include "common/runtime/data_file.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine_files {

Result<engine::EngineTexts> ReadTexts(const Wish& wish) {
  engine::EngineTexts texts;
  auto biped = config::ReadDataFile(engine::kBipedFile, wish.data_folder);
  if (!biped) return biped.error();
  auto mapping_table =
      wish.mapping_table.empty()
          ? config::ReadDataFile(mapping::MappingFileOf(wish.interface), wish.data_folder)
          : config::ReadTextFile(wish.mapping_table);
  if (!mapping_table) return mapping_table.error();
  auto track = config::ReadNamedOrPath(wish.track, "tracks", wish.data_folder);
  if (!track) return track.error();
  // The engine does not know the names of the files.
  if (const auto parsed = terrain::ParseTrack(*track, wish.track); !parsed) return parsed.error();
  if (!wish.mapping_table.empty()) {
    const auto mapped =
        mapping::AnyInterface::Create({.interface = wish.interface}, *mapping_table);
    if (!mapped) {
      return Error{mapped.error().kind,
                   wish.mapping_table + ", in place of " + mapped.error().message};
    }
  }
  texts.biped = std::move(*biped);
  texts.mapping = std::move(*mapping_table);
  texts.track = std::move(*track);
  for (const char* name : engine::kGainFiles) {
    auto gains = config::ReadDataFile(name, wish.data_folder);
    if (!gains) return gains.error();
    texts.gains.push_back({name, std::move(*gains)});
  }
  for (const std::string& path : wish.more_gains) {
    auto gains = config::ReadTextFile(path);
    if (!gains) return gains.error();
    texts.gains.push_back({path, std::move(*gains)});
  }
  return texts;
}

Result<mapping::AnyInterface> ReadInterface(const mapping::InterfaceOptions& options,
                                            const std::string& data_folder) {
  const auto table = config::ReadDataFile(mapping::MappingFileOf(options.interface), data_folder);
  if (!table) return table.error();
  return mapping::AnyInterface::Create(options, *table);
}

}  // namespace footing::engine_files
