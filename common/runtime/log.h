#pragma once

#include <string>

/// Log lines to standard error. Only at the edge that decides, never on the simulation thread and
/// never in pure code.
namespace footing::log {

/// Sets the program's name in every line. `quiet` keeps only warnings and errors. A program that
/// never calls it logs under the name of its file.
void Start(const std::string& program, bool quiet);

void Info(const std::string& line);
void Warning(const std::string& line);
void Error(const std::string& line);

}  // namespace footing::log
