#include "daemon/sensor/service/reload.h"

#include "common/runtime/reload.h"

namespace footing::sensor {

Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say) {
  Config old_config = before, new_config = wanted, next = before;
  config::Binder old_binder, new_binder, next_binder;
  old_config.Bind(old_binder);
  new_config.Bind(new_binder);
  next.stale_after_s = wanted.stale_after_s;
  next.default_rig = wanted.default_rig;
  next.motion_plus = wanted.motion_plus;
  next.camera = wanted.camera;
  next.status_interval_s = wanted.status_interval_s;
  next.sessions = wanted.sessions;
  next.access.token_file = wanted.access.token_file;
  next.access.view_token_file = wanted.access.view_token_file;
  next.access.clients_file = wanted.access.clients_file;
  next.Bind(next_binder);
  for (const auto& line :
       config::DescribeReload(old_binder, next_binder, new_binder, changed_files)) {
    say(line);
  }
  return next;
}

}  // namespace footing::sensor
