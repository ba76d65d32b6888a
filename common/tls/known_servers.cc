#include "common/tls/known_servers.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/tls/fingerprint.h"

namespace footing::tls {
Result<std::optional<std::string>> KnownServers::Find(const std::string& server) const {
  std::ifstream file(path_);
  if (!file) {
    if (errno == ENOENT) return std::optional<std::string>();
    return Failure(path_ + ": " + std::strerror(errno));
  }
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
    return Failure("there is no home folder to keep it in; name a file by FOOTING_KNOWN_SERVERS");
  }
  for (std::size_t slash = path_.find('/', 1); slash != std::string::npos;
       slash = path_.find('/', slash + 1)) {
    mkdir(path_.substr(0, slash).c_str(), S_IRWXU);  // What fails shows when the file is opened.
  }
  const int file =
      open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return Failure(path_ + ": " + std::strerror(errno));
  const std::string line = server + " " + fingerprint + "\n";
  const bool written = write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  const std::string why = std::strerror(errno);
  close(file);
  return written ? Result<void>() : Failure(path_ + ": " + why);
}

}  // namespace footing::tls
