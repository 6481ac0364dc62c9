// Where a mesh of a URDF file lies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "import/find-mesh.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>

namespace tw {

namespace fs = std::filesystem;

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The file, or the one beside it whose name differs by capitals alone.
std::optional<std::string> existing(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) return path.lexically_normal().string();
  const std::string wanted = lower(path.filename().string());
  std::vector<std::string> alike;
  for (fs::directory_iterator at(path.parent_path(), ignored), end; !ignored && at != end;
       at.increment(ignored))
    if (lower(at->path().filename().string()) == wanted && at->is_regular_file(ignored))
      alike.push_back(at->path().string());
  if (alike.empty()) return std::nullopt;
  return fs::path(*std::min_element(alike.begin(), alike.end())).lexically_normal().string();
}

std::vector<fs::path> folders_above(const std::string& file) {
  std::vector<fs::path> found;
  for (fs::path at = fs::absolute(file).parent_path();; at = at.parent_path()) {
    found.push_back(at);
    if (at == at.parent_path()) return found;
  }
}

std::vector<std::string> ros_packages() {
  std::vector<std::string> found;
  const char* given = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream all(given ? given : "");
  for (std::string path; std::getline(all, path, ':');)
    if (!path.empty()) found.push_back(path);
  return found;
}

}  // namespace

std::string find_mesh(const std::string& name, const std::string& file,
                      const std::vector<std::string>& packages) {
  const fs::path folder = fs::absolute(file).parent_path();
  const std::size_t scheme = name.find("://");
  const std::string kind = scheme == std::string::npos ? "" : name.substr(0, scheme);
  if (kind != "package" && kind != "model") {
    const fs::path path = folder / (kind == "file" ? name.substr(scheme + 3) : name);
    return existing(path).value_or(path.lexically_normal().string());
  }
  const std::size_t begin = name.find_first_not_of('/', scheme + 1);
  if (begin == std::string::npos) return name;
  const fs::path inside = name.substr(begin);
  const fs::path package = *inside.begin(), rest = inside.lexically_relative(package);
  std::vector<fs::path> candidates;
  for (const fs::path path : packages) {
    candidates.push_back(path / inside);
    const bool itself = (path.filename().empty() ? path.parent_path() : path).filename() == package;
    if (itself) candidates.push_back(path / rest);
  }
  const std::vector<fs::path> above = folders_above(file);
  for (const fs::path& path : above) candidates.push_back(path / inside);
  for (const fs::path& path : above) candidates.push_back(path / rest);
  for (const fs::path path : ros_packages()) {
    candidates.push_back(path / inside);
    candidates.push_back(path / rest);
  }
  for (const fs::path& path : candidates)
    if (const auto found = existing(path)) return *found;
  return name;
}

}  // namespace tw
