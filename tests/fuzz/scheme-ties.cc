// Multibodies, springs, holds and callbacks of a described scene as Scheme.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/scheme-ties.h"

#include <cmath>

#include "base/error.h"

namespace tw::fuzz {
namespace {

using multibody::AxisSpec;
using multibody::JointKind;
using multibody::JointSpec;

std::string short_name(const DescribedBody& link) {
  return link.name.substr(link.hanging->multibody.size() + 1);
}

// One axis' number, or both where they are two.
std::string law_text(const JointSpec& joint, const char* name, double AxisSpec::*number) {
  const double first = joint.axes[0].*number, second = joint.axes[1].*number;
  if (joint.kind == JointKind::universal)
    return std::string(" ") + name + " #(" + show(first) + " " + show(second) + ")";
  return std::string(" ") + name + " " + show(first);
}

std::string joint_text(const JointSpec& joint) {
  const std::string at =
      " #:at " + text(joint.placement.p) + " #:orientation " + text(joint.placement.q);
  const std::string laws = law_text(joint, "#:damping", &AxisSpec::damping) +
                           law_text(joint, "#:friction", &AxisSpec::friction) +
                           law_text(joint, "#:stiffness", &AxisSpec::stiffness);
  const auto along_axis = [&](const char* kind) {
    std::string form = std::string("(") + kind + " #:axis " + text(joint.axis) + at + laws;
    const AxisSpec& axis = joint.axes[0];
    if (std::isfinite(axis.lower))
      form += " #:limits '(" + show(axis.lower) + " " + show(axis.upper) + ") #:restitution " +
              show(axis.restitution);
    return form + ")";
  };
  switch (joint.kind) {
    case JointKind::weld: return "(weld" + at + ")";
    case JointKind::universal: return "(universal" + at + laws + ")";
    case JointKind::spherical: return "(spherical" + at + laws + ")";
    case JointKind::prismatic: return along_axis("prismatic");
    default: return along_axis("revolute");
  }
}

// A link with what hangs on it.
std::string link_text(const DescribedScene& scene, const DescribedBody& link) {
  const Hanging& hanging = *link.hanging;
  std::string form = "\n  (link '" + short_name(link);
  if (!hanging.free) form += " #:joint " + joint_text(hanging.joint);
  form += "\n    #:density " + show(link.density) + " #:shape " + shape_text(link);
  if (!scene.callbacks.empty()) form += slots_text;
  for (const DescribedBody& other : scene.bodies)
    if (other.hanging && other.hanging->parent == link.name) form += link_text(scene, other);
  return form + ")";
}

std::string body_text(const std::string& name) { return "(find-body \"" + name + "\")"; }

const char* name_of(Deed deed) {
  switch (deed) {
    case Deed::turn: return "turn";
    case Deed::feel: return "feel";
    case Deed::grip: return "grip";
    case Deed::lean: return "lean";
    case Deed::reach: break;
  }
  return "reach";
}

// deeds.cc
const char* const deeds_text = R"((define (count-up! view)
  (set! (slot view 'count) (1+ (slot view 'count)))
  (slot view 'count))
(define (turn period torque)
  (lambda (time view)
    (when (and (odd? (count-up! view)) (< (random-real! view) 1/2))
      (let ((v (velocity view)))
        (set! (velocity view) (vector (vector-ref v 1) (vector-ref v 2) (vector-ref v 0)))))))
(define (feel period torque)
  (lambda (time view other)
    (when (and (pair? (contacts #:body view)) (odd? (count-up! view)))
      (set! (angular-velocity view) (v* -1 (angular-velocity view))))))
(define (grip period torque)
  (lambda (time view other)
    (count-up! view)
    (if (attached? view other) (detach! view other) (attach! view other))
    (+ time (* period (+ 0.5 (random-real! view))))))
(define (reach period torque)
  (lambda (time view)
    (let* ((count (count-up! view))
           (torques (joint-torques view))
           (last (1- (vector-length torques)))
           (pushed (if (> (vector-ref (joint-velocities view) last) 0) (- torque) torque))
           (new (vector-copy torques)))
      (vector-set! new last (if (zero? (modulo count 3)) 0. pushed))
      (set! (joint-torques view) new))))
(define (lean period torque)
  (lambda (time view other)
    (let* ((turn (modulo (count-up! view) 3))
           (felt (case turn
                   ((1) (v+ (spring-force view other) (hold-force view other)))
                   ((2) (rotate (orientation view) (accelerometer view)))
                   (else #(0 0 0))))
           (length (norm felt)))
      (set! (applied-force view)
            (if (> length 0) (v* (- (/ torque length)) felt) #(0 0 0))))))
(on-collision! #t #t
  (lambda (collision . views)
    (for-each count-up! views)))
)";

}  // namespace

std::string multibody_text(const DescribedScene& scene, std::size_t& first) {
  const DescribedBody& root = scene.bodies[first];
  const std::string& name = root.hanging->multibody;
  std::string form = "(add-multibody! #:name \"" + name + "\"" +
                     (root.hanging->free ? " #:base 'free" : "") + "\n  #:position " +
                     text(root.pose.p) + " #:orientation " + text(root.pose.q) +
                     link_text(scene, root) + ")\n";
  std::string velocities;
  for (; first < scene.bodies.size(); ++first) {
    const auto& hanging = scene.bodies[first].hanging;
    if (!hanging || hanging->multibody != name) break;
    for (const double u : hanging->velocity)
      velocities += (velocities.empty() ? "" : " ") + show(u);
  }
  return form + "(set! (joint-velocities (find-multibody \"" + name + "\")) #(" + velocities +
         "))\n";
}

std::string bonds_text(const DescribedScene& scene) {
  std::string all;
  for (const DescribedBond& bond : scene.bonds) {
    const std::string ends = body_text(bond.a) + " " + body_text(bond.b);
    if (bond.holds) {
      all += "(attach! " + ends + ")\n";
      continue;
    }
    all += "(add-spring! " + ends + " #:at-a " + text(bond.spring.at_a) + " #:at-b " +
           text(bond.spring.at_b) + "\n  #:stiffness " + show(bond.spring.stiffness) +
           " #:damping " + show(bond.spring.damping) +
           (bond.spring.rest ? " #:rest " + show(*bond.spring.rest) : "") + ")\n";
  }
  return all;
}

std::string callbacks_text(const DescribedScene& scene) {
  if (scene.callbacks.empty()) return {};
  std::string all = deeds_text;
  for (const DescribedCallback& callback : scene.callbacks) {
    std::string targets;
    for (const std::string& name : callback.targets)
      targets += (targets.empty() ? "" : " ") + body_text(name);
    all += "(add-callback! (list " + targets + ") (" + name_of(callback.deed) + " " +
           show(callback.period) + " " + show(callback.torque) + ") #:start " +
           show(callback.start) +
           (callback.deed == Deed::grip ? "" : " #:period " + show(callback.period)) + ")\n";
  }
  return all;
}

}  // namespace tw::fuzz
