// Scheme primitives: versions of the program and of the libraries it uses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <libqhull_r/libqhull_r.h>

#include <nlohmann/json.hpp>

#include "math/vec.h"
#include "script/primitive.h"
#include "script/values.h"

#ifndef PACKAGE_VERSION
#define PACKAGE_VERSION "0.1.0"
#endif

namespace tw {

TW_PRIMITIVES(define_versions)

static std::string dotted(int a, int b, int c) {
  return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
}

TW_PRIMITIVE(version, "%version", (), "Return the version of timewarp.") {
  return from_string(PACKAGE_VERSION);
}

TW_PRIMITIVE(libraries, "%libraries", (), "Return an alist of libraries and their versions.") {
  const std::string eigen = dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  const std::string json =
      dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
  return scm_list_3(scm_cons(from_string("Eigen"), from_string(eigen)),
                    scm_cons(from_string("Qhull"), from_string(qh_version)),
                    scm_cons(from_string("nlohmann-json"), from_string(json)));
}

}  // namespace tw
