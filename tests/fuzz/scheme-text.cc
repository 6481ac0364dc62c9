// A described scene as a file that the command runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "base/error.h"
#include "fuzz/described-scene.h"
#include "fuzz/scheme-ties.h"

namespace tw::fuzz {

std::string text(const Vec3& v) {
  return "#(" + show(v.x()) + " " + show(v.y()) + " " + show(v.z()) + ")";
}

std::string text(const Quat& q) {
  return "#(" + show(q.w()) + " " + show(q.x()) + " " + show(q.y()) + " " + show(q.z()) + ")";
}

namespace {

std::string solid_text(const Solid& solid) {
  switch (solid.kind) {
    case SolidKind::ball: return "(sphere " + show(solid.radius) + ")";
    case SolidKind::box:
      return "(box " + show(solid.edges.x()) + " " + show(solid.edges.y()) + " " +
             show(solid.edges.z()) + ")";
    case SolidKind::cylinder:
      return "(cylinder " + show(solid.radius) + " " + show(solid.length) + ")";
    case SolidKind::capsule:
      return "(capsule " + show(solid.radius) + " " + show(solid.length) + ")";
    case SolidKind::cone: return "(cone " + show(solid.radius) + " " + show(solid.length) + ")";
    case SolidKind::ellipsoid:
      return "(ellipsoid " + show(0.5 * solid.edges.x()) + " " + show(0.5 * solid.edges.y()) + " " +
             show(0.5 * solid.edges.z()) + ")";
    case SolidKind::half_space:
      return "(half-space " + text(solid.normal) + " " + show(solid.offset) + ")";
    case SolidKind::hull: break;
  }
  std::string points = "(convex '(";
  for (const Vec3& p : solid.points) points += "\n      " + text(p);
  return points + "))";
}

// procedures.cc, mesh-text.cc
const char* const swing_text = R"((define (swing p q along turn period)
  (let ((angle (norm turn)))
    (lambda (time)
      (let ((share (sin (* (/ 6.283185307179586 period) time))))
        (values (v+ p (v* share along))
                (if (> angle 0) (q* (rotation turn (* share angle)) q) q))))))
)";
const char* const mesh_text = R"((define (mesh text)
  (let ((file (string-append (mkdtemp "/tmp/fuzz-mesh-XXXXXX") "/mesh.obj")))
    (call-with-output-file file (lambda (port) (display text port)))
    (load-shape file)))
)";

std::string mesh_text_of(const Hills& hills) {
  std::string all = "(triangle-mesh '(";
  for (std::size_t i = 0; i < hills.heights.size(); ++i)
    all += "\n      " + text(hills.corner(i / hills.columns, i % hills.columns));
  all += ")\n    '(";
  for (const auto& [a, b, c] : hills.triangles())
    all +=
        "\n      #(" + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + ")";
  return all + "))";
}

std::string hills_text(const Hills& hills) {
  if (hills.as_mesh) return mesh_text_of(hills);
  std::string rows = "(height-field '(";
  for (std::size_t i = 0; i < hills.heights.size(); ++i) {
    if (i % hills.columns == 0) rows += i == 0 ? "\n      (" : ")\n      (";
    rows += " " + show(hills.heights[i]);
  }
  return rows + ")) #:spacing " + show(hills.spacing) + ")";
}

}  // namespace

std::string shape_text(const DescribedBody& body) {
  if (body.mesh) return "(mesh \"" + obj_text(body) + "\")";
  if (body.hills) return hills_text(*body.hills);
  const auto placed_text = [](const Solid& solid) {
    return "(placed " + solid_text(solid) + " #:position " + text(solid.placement.p) +
           " #:orientation " + text(solid.placement.q) + ")";
  };
  if (body.solids.size() == 1) {
    const Solid& solid = body.solids.front();
    return solid.placed() ? placed_text(solid) : solid_text(solid);
  }
  std::string shape = "(union";
  for (const Solid& solid : body.solids) shape += "\n    " + placed_text(solid);
  return shape + ")";
}

namespace {

std::string body_form(const DescribedBody& body, bool counts) {
  std::string form = "(add-body! #:name \"" + body.name + "\"" + (counts ? slots_text : "") +
                     "\n  #:shape " + shape_text(body) + "\n ";
  if (body.swing) {
    const Swing& swing = *body.swing;
    return form + " #:motion (swing " + text(body.pose.p) + " " + text(body.pose.q) + "\n    " +
           text(swing.along) + " " + text(swing.turn) + " " + show(swing.period) +
           ")\n  #:max-speed " + show(swing.max_speed(shape_of(body)->radius_about_origin())) +
           ")\n";
  }
  if (body.kinematic()) {
    form += " #:motion (keyframes '(";
    for (const Keyframe& frame : body.keyframes)
      form += "\n    (" + show(frame.time) + " " + text(frame.position) +
              (frame.orientation ? " " + text(*frame.orientation) : "") + ")";
    return form + ")" + (body.smooth ? " #:smooth? #t))\n" : "))\n");
  }
  form += " #:position " + text(body.pose.p) + " #:orientation " + text(body.pose.q);
  if (body.fixed) return form + " #:fixed? #t)\n";
  return form + "\n  #:velocity " + text(body.velocity) + " #:angular-velocity " + text(body.spin) +
         " #:density " + show(body.density) + ")\n";
}

}  // namespace

std::string scheme_text(const DescribedScene& scene) {
  std::string all = ";; fuzz-scenes --kind=" + scene.kind +
                    " --seeds=" + std::to_string(scene.seed) + ": size " + show(scene.size) +
                    " m, time unit " + show(scene.time_unit) + " s\n";
  const bool swings = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                  [](const DescribedBody& body) { return body.swing; });
  const bool meshes = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                  [](const DescribedBody& body) { return body.mesh; });
  all += scene.callbacks.empty() && scene.forces.empty() && !swings
             ? "(use-modules (timewarp))\n"
             : "(use-modules (timewarp) (timewarp vectors))\n";
  if (swings) all += swing_text;
  if (meshes) all += mesh_text;
  all += "(scene #:title \"" + scene.name() + "\" #:duration " + show(scene.duration) +
         " #:gravity " + text(scene.gravity) + "\n  #:accuracy " + show(scene.accuracy) +
         " #:fps " + show(60 / scene.duration) + ")\n";
  all +=
      "(set-contact-parameters! #t #t #:restitution " + show(scene.restitution) + " #:friction " +
      show(scene.friction) +
      (scene.rolling > 0 || scene.spinning > 0 ? "\n  #:rolling-friction " + show(scene.rolling) +
                                                     " #:spinning-friction " + show(scene.spinning)
                                               : "") +
      ")\n";
  for (std::size_t i = 0; i < scene.bodies.size();) {
    if (scene.bodies[i].hanging)
      all += multibody_text(scene, i);
    else
      all += body_form(scene.bodies[i++], !scene.callbacks.empty());
  }
  all += bonds_text(scene) + forces_text(scene) + servos_text(scene) + callbacks_text(scene);
  Vec3 center = Vec3::Zero();
  double count = 0;
  for (const DescribedBody& body : scene.bodies)
    if (body.dynamic()) center += (body.pose.p - center) / ++count;
  const Vec3 eye = center + Vec3(4, -12, 6) * scene.size;
  return all + "(camera #:eye " + text(eye) + " #:target " + text(center) + ")\n";
}

}  // namespace tw::fuzz
