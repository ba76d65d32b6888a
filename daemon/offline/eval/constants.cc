#include "daemon/offline/eval/constants.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>

namespace footing::eval {

Result<void> SetConstants(const std::vector<std::string>& assignments,
                          reconstruction::BestConstants& c) {
  const std::map<std::string, double*> names = {
      {"hand_sd_m", &c.hand_sd_m},
      {"arm_spread", &c.arm_spread},
      {"belt_sd_rad", &c.belt_sd_rad},
      {"foot_along", &c.foot.along},
      {"foot_across", &c.foot.across},
      {"ankle_up", &c.foot.ankle_up},
      {"toe_up", &c.foot.toe_up},
      {"lift", &c.foot.lift},
      {"lift_time_s", &c.foot.lift_time_s},
      {"ahead", &c.foot.ahead},
      {"ankle_rise", &c.foot.ankle_rise},
      {"toe_rise", &c.foot.toe_rise},
      {"forward", &c.foot.forward},
      {"air_level", &c.foot.air_level},
      {"air_up", &c.foot.air_up},
      {"aloft_sd_m", &c.aloft_sd_m},
      {"aloft_time_s", &c.aloft_time_s},
      {"spread", &c.spread},
      {"arm_joint_spread", &c.arm_joint_spread},
      {"com_spread", &c.com_spread},
      {"com_sd_m", &c.com_sd_m},
      {"angular_sd", &c.angular_sd},
      {"prior_weight", &c.prior_weight},
      {"smooth_weight", &c.smooth_weight},
      {"regressed_prior_weight", &c.regressed_prior_weight},
      {"regressed_smooth_weight", &c.regressed_smooth_weight},
  };
  for (const std::string& assignment : assignments) {
    const auto equal = assignment.find('=');
    const auto found = names.find(assignment.substr(0, equal));
    char* end = nullptr;
    const double value =
        equal == std::string::npos ? NAN : std::strtod(assignment.c_str() + equal + 1, &end);
    if (found == names.end() || !std::isfinite(value) || *end != '\0') {
      std::string list;
      for (const auto& [name, place] : names) list += (list.empty() ? "" : ", ") + name;
      return UsageError("--constant " + assignment + ": say NAME=VALUE with one of " + list);
    }
    *found->second = value;
  }
  return {};
}

}  // namespace footing::eval
