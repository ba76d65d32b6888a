#include "daemon/simulation/footing_sim/reload.h"

#include "common/runtime/reload.h"

namespace footing::footing_sim {

Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say) {
  Config old_config = before, new_config = wanted, next = before;
  next.serving.sessions = wanted.serving.sessions;
  next.serving.access.token_file = wanted.serving.access.token_file;
  next.serving.access.view_token_file = wanted.serving.access.view_token_file;
  next.serving.access.clients_file = wanted.serving.access.clients_file;
  config::Binder old_binder, new_binder, next_binder;
  old_config.Bind(old_binder);
  new_config.Bind(new_binder);
  next.Bind(next_binder);
  for (const auto& line :
       config::DescribeReload(old_binder, next_binder, new_binder, changed_files)) {
    say(line);
  }
  return next;
}

}  // namespace footing::footing_sim
