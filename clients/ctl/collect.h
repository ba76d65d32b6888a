#pragma once

#include <string>

#include "clients/ctl/report/parse.h"

namespace footing::ctl {

/// Reads what the doctor wants to know of the host below `root` ("/", or a folder made for a test).
/// bluetoothctl is asked only at "/", for at most 2 s a question. What can't be read is left out.
doctor::Facts CollectHost(const std::string& root);

/// Output of bluetoothctl with these constant words; empty when it is not there or does not answer
/// within 2 s.
std::string AskBluetoothctl(const std::string& words);

}  // namespace footing::ctl
