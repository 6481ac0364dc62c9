// Writing files under a temporary name.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/whole-file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.h"

namespace tw {

namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw UserError("cannot write '" + path + "': " + std::strerror(error));
}

// 0, or the errno of what failed.
int write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  std::size_t written = 0;
  int error = 0;
  while (written < bytes.size() && error == 0) {
    const ssize_t n = write(file, bytes.data() + written, bytes.size() - written);
    if (n >= 0)
      written += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      error = errno;
  }
  if (close(file) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

bool is_special_file(const std::string& path) {
  struct stat status;
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

void write_whole_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  if (is_special_file(path)) {
    if (const int error = write_bytes(path, bytes)) fail(path, error);
    return;
  }
  const std::string part = path + ".part";
  int error = write_bytes(part, bytes);
  if (error == 0 && std::rename(part.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(part.c_str());
    fail(path, error);
  }
}

void make_writable_folder(const std::string& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw UserError("cannot make the folder '" + folder + "': " + error.message());
  TW_REQUIRE(std::filesystem::is_directory(folder, error),
             "cannot write into '" + folder + "': it is not a folder");
  TW_REQUIRE(access(folder.c_str(), W_OK | X_OK) == 0,
             "cannot write into the folder '" + folder + "': " + std::strerror(errno));
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return "";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace tw
