// Positions and velocities of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/coordinates.h"

#include "math/rotation-vector.h"

namespace tw::multibody {
namespace {

// Calls scalar(q, u), ball(q, u) or floating(q, u) with the first indices of each node's
// coordinates and dofs.
template <class Scalar, class Ball, class Floating>
void for_each_node(const Tree& tree, Scalar scalar, Ball ball, Floating floating) {
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const std::size_t q = static_cast<std::size_t>(node.q), u = static_cast<std::size_t>(node.u);
    if (node.kind == NodeKind::ball)
      ball(q, u);
    else if (node.kind == NodeKind::floating)
      floating(q, u);
    else
      scalar(q, u);
  }
}

Quat pure(const Vec3& w) { return Quat(0, w.x(), w.y(), w.z()); }

void set_half_product(double* rate, const Quat& a, const Quat& b) {
  Quat product = a * b;
  product.coeffs() *= 0.5;
  set_quaternion(rate, product);
}

// (s 1 + [a]x)^-1 r = (s^2 r - s a x r + a (a.r)) / (s (s^2 + |a|^2))
void solve_turning(double s, const Vec3& a, double* r) {
  const Vec3 x = vector_at(r);
  set_vector(r, (s * s * x - s * a.cross(x) + a * a.dot(x)) / (s * (s * s + a.squaredNorm())));
}

}  // namespace

void neutral_position(const Tree& tree, Out q) {
  for (double& x : q) x = 0;
  for_each_node(
      tree, [](std::size_t, std::size_t) {}, [&](std::size_t i, std::size_t) { q[i] = 1; },
      [&](std::size_t i, std::size_t) { q[i + 3] = 1; });
}

void displace(const Tree& tree, In q0, In z, Out q) {
  for_each_node(
      tree, [&](std::size_t i, std::size_t k) { q[i] = q0[i] + z[k]; },
      [&](std::size_t i, std::size_t k) {
        const Quat turned = quaternion_at(&q0[i]) * short_rotation(vector_at(&z[k]));
        set_quaternion(&q[i], turned.normalized());
      },
      [&](std::size_t i, std::size_t k) {
        set_vector(&q[i], vector_at(&q0[i]) + vector_at(&z[k]));
        const Quat turned = short_rotation(vector_at(&z[k + 3])) * quaternion_at(&q0[i + 3]);
        set_quaternion(&q[i + 3], turned.normalized());
      });
}

void difference(const Tree& tree, In q0, In q, Out z) {
  for_each_node(
      tree, [&](std::size_t i, std::size_t k) { z[k] = q[i] - q0[i]; },
      [&](std::size_t i, std::size_t k) {
        // R = R0 exp(z) = exp(R0 z) R0
        const Quat from = quaternion_at(&q0[i]);
        set_vector(&z[k], from.conjugate() * turn_between(from, quaternion_at(&q[i])));
      },
      [&](std::size_t i, std::size_t k) {
        set_vector(&z[k], vector_at(&q[i]) - vector_at(&q0[i]));
        set_vector(&z[k + 3], turn_between(quaternion_at(&q0[i + 3]), quaternion_at(&q[i + 3])));
      });
}

void normalize(const Tree& tree, Out q) {
  const auto to_unit = [&](std::size_t i) {
    set_quaternion(&q[i], quaternion_at(&q[i]).normalized());
  };
  for_each_node(
      tree, [](std::size_t, std::size_t) {}, [&](std::size_t i, std::size_t) { to_unit(i); },
      [&](std::size_t i, std::size_t) { to_unit(i + 3); });
}

void position_rate(const Tree& tree, In q, In u, Out rate) {
  for_each_node(
      tree, [&](std::size_t i, std::size_t k) { rate[i] = u[k]; },
      [&](std::size_t i, std::size_t k) {
        set_half_product(&rate[i], quaternion_at(&q[i]), pure(vector_at(&u[k])));
      },
      [&](std::size_t i, std::size_t k) {
        set_vector(&rate[i], vector_at(&u[k]));
        set_half_product(&rate[i + 3], pure(vector_at(&u[k + 3])), quaternion_at(&q[i + 3]));
      });
}

void chart_rate(const Tree& tree, In z, In u, Out rate) {
  for_each_node(
      tree, [&](std::size_t, std::size_t k) { rate[k] = u[k]; },
      [&](std::size_t, std::size_t k) {
        // the chart from the right is that from the left of the inverse
        set_vector(&rate[k], rotation_vector_rate(-vector_at(&z[k]), vector_at(&u[k])));
      },
      [&](std::size_t, std::size_t k) {
        set_vector(&rate[k], vector_at(&u[k]));
        set_vector(&rate[k + 3], rotation_vector_rate(vector_at(&z[k + 3]), vector_at(&u[k + 3])));
      });
}

void solve_chart_rate(const Tree& tree, In u, double s, Out r) {
  for_each_node(
      tree, [&](std::size_t, std::size_t k) { r[k] /= s; },
      [&](std::size_t, std::size_t k) { solve_turning(s, 0.5 * vector_at(&u[k]), &r[k]); },
      [&](std::size_t, std::size_t k) {
        for (std::size_t c = 0; c < 3; ++c) r[k + c] /= s;
        solve_turning(s, -0.5 * vector_at(&u[k + 3]), &r[k + 3]);
      });
}

}  // namespace tw::multibody
