// The headers of others that nearly every file includes, compiled once.
//
// Only a matter of build time: every file of ours still includes what it uses, which
// `make distcheck` proves by building with --disable-precompiled-header.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>
