#include "common/net/known_servers.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/net/tls_context.h"
#include "common/runtime/files.h"

namespace footing::tls {
namespace {

/// A person's editor may have left the last line without an end.
bool EndsWithinLine(int file) {
  struct stat status {};
  char last = '\n';
  if (fstat(file, &status) != 0 || status.st_size == 0) return false;
  return pread(file, &last, 1, status.st_size - 1) == 1 && last != '\n';
}

}  // namespace

Result<std::optional<std::string>> KnownServers::Find(const std::string& server) const {
  if (access(path_.c_str(), F_OK) != 0 && errno == ENOENT) return std::optional<std::string>();
  // A file that cannot be read may have had the server: it must not be taken for a new one.
  const auto all = config::ReadTextFile(path_);
  if (!all) return all.error();
  std::istringstream file(*all);
  std::optional<std::string> found;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    std::string name, text, more;
    if (!(words >> name) || name.front() == '#') continue;
    const bool two = static_cast<bool>(words >> text) && !(words >> more);
    const auto fingerprint = two ? ParseFingerprint(text) : std::nullopt;
    if (!fingerprint) {
      return InvalidData(path_ + ", line " + std::to_string(number) +
                         ": it must be HOST:PORT and a certificate's fingerprint sha256:...");
    }
    if (name == server) found = fingerprint;
  }
  return found;
}

Result<void> KnownServers::Add(const std::string& server, const std::string& fingerprint) const {
  if (path_.empty()) {
    return Failure("there is no home folder to keep it in; set FOOTING_KNOWN_SERVERS to a file");
  }
  if (auto made = config::MakeFoldersAbove(path_); !made) return made;
  const int file = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return Failure(path_ + ": " + std::strerror(errno));
  const std::string line = (EndsWithinLine(file) ? "\n" : "") + server + " " + fingerprint + "\n";
  const bool written = write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const std::string why = std::strerror(errno);
  close(file);
  return written ? Result<void>() : Failure(path_ + ": " + why);
}

namespace {

std::string Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The file in the folder of Footing: below $`variable` if set, else below ~/`in_home`.
std::string FootingFile(const char* variable, const std::string& in_home, const std::string& file) {
  const std::string xdg = Variable(variable);
  if (!xdg.empty()) return xdg + "/footing/" + file;
  const std::string home = Variable("HOME");
  return home.empty() ? "" : home + "/" + in_home + "/footing/" + file;
}

}  // namespace

std::string DefaultIdentityFile() {
  const std::string systemd = Variable("STATE_DIRECTORY");
  if (!systemd.empty()) return systemd.substr(0, systemd.find(':')) + "/identity.pem";
  return FootingFile("XDG_STATE_HOME", ".local/state", "identity.pem");
}

std::string KnownServersFile() {
  const std::string named = Variable("FOOTING_KNOWN_SERVERS");
  return named.empty() ? FootingFile("XDG_CONFIG_HOME", ".config", "known_servers") : named;
}

std::string ClientIdentityFile() {
  const std::string known = KnownServersFile();
  return known.empty() ? "" : known.substr(0, known.rfind('/') + 1) + "client.pem";
}

}  // namespace footing::tls
