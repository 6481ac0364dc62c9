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
    case JointKind::spherical: {
      const AxisSpec& axis = joint.axes[0];
      std::string limits;
      if (std::isfinite(axis.upper))
        limits = " #:limits " + show(axis.upper) + " #:restitution " + show(axis.restitution);
      if (joint.swinging) limits += " #:axis " + text(*joint.swinging);
      return "(spherical" + at + laws + limits + ")";
    }
    case JointKind::prismatic: return along_axis("prismatic");
    default: return along_axis("revolute");
  }
}

// A link with what hangs on it.
std::string link_text(const DescribedScene& scene, const DescribedBody& link) {
  const Hanging& hanging = *link.hanging;
  std::string form = "\n  (link '" + short_name(link);
  if (!hanging.free) form += " #:joint " + joint_text(hanging.joint);
  if (link.bare())
    form += "\n    #:mass " + show(link.bare_mass) + " #:inertia " +
            text(link.bare_moment * Vec3::Ones()) + " #:center-of-mass #(0 0 0)";
  else
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
    case Deed::scan: return "scan";
    case Deed::mind: return "mind";
    case Deed::steady: return "steady";
    case Deed::strain: return "strain";
    case Deed::reach: break;
  }
  return "reach";
}

// deeds.cc
const char* const deeds_text = R"((define (count-up! view)
  (set! (slot view 'count) (1+ (slot view 'count)))
  (slot view 'count))
(define (turn period torque reach)
  (lambda (time view)
    (when (and (odd? (count-up! view)) (< (random-real! view) 1/2))
      (let ((v (velocity view)))
        (set! (velocity view) (vector (vector-ref v 1) (vector-ref v 2) (vector-ref v 0)))))))
(define (feel period torque reach)
  (lambda (time view other)
    (when (and (pair? (contacts #:body view)) (odd? (count-up! view)))
      (set! (angular-velocity view) (v* -1 (angular-velocity view))))))
(define (grip period torque reach)
  (lambda (time view other)
    (count-up! view)
    (if (attached? view other) (detach! view other) (attach! view other))
    (+ time (* period (+ 0.5 (random-real! view))))))
(define (reach period torque distance)
  (lambda (time view)
    (let* ((count (count-up! view))
           (torques (joint-torques view))
           (last (1- (vector-length torques)))
           (pushed (if (> (vector-ref (joint-velocities view) last) 0) (- torque) torque))
           (new (vector-copy torques)))
      (vector-set! new last (if (zero? (modulo count 3)) 0. pushed))
      (set! (joint-torques view) new))))
(define (lean period torque reach)
  (lambda (time view other)
    (let* ((turn (modulo (count-up! view) 3))
           (felt (case turn
                   ((1) (v+ (spring-force view other) (hold-force view other)))
                   ((2) (rotate (orientation view) (accelerometer view)))
                   (else #(0 0 0))))
           (length (norm felt)))
      (set! (applied-force view)
            (if (> length 0) (v* (- (/ torque length)) felt) #(0 0 0))))))
(define (turn-away! view normal)
  (let* ((v (velocity view)) (into (dot v normal)))
    (when (< into 0)
      (set! (velocity view) (v- v (v* (* 2 into) normal))))))
(define (turn-spin-round! view)
  (set! (angular-velocity view) (v* -1 (angular-velocity view))))
(define (scan period torque reach)
  (lambda (time view . others)
    (if (odd? (count-up! view))
        (let* ((v (velocity view))
               (way (if (> (norm v) 0) (normalize v) #(0 0 -1)))
               (hit (ray-cast (position view) way #:max-distance reach #:bodies others)))
          (when hit (turn-away! view (hit-normal hit))))
        (when (rangefinder view #(1 0 0) #:max-distance reach #:bodies others)
          (turn-spin-round! view)))))
(define (mind period torque reach)
  (lambda (time view . others)
    (count-up! view)
    (let ((start (position view)))
      (call-with-values (lambda () (closest-points view (car others)))
        (lambda (mine theirs distance)
          (let ((apart (v- mine theirs)))
            (when (and (< distance reach) (> (norm apart) 0))
              (turn-away! view (normalize apart))))))
      (let ((touched (overlapping (sphere reach) #:position start #:bodies others))
            (low? (call-with-values (lambda () (bounding-box view))
                    (lambda (lo hi) (< (vector-ref lo 2) (- (vector-ref start 2) reach))))))
        (when (or (even? (length touched)) low?)
          (turn-spin-round! view))))))
(define (against felt length)
  (if (> (norm felt) 0) (v* (- (/ length (norm felt))) felt) #(0 0 0)))
(define (felt-torque view other)
  (let loop ((contacts (contacts #:body view)) (sum (hold-torque view other)))
    (if (null? contacts)
        sum
        (loop (cdr contacts)
              (v+ sum (v* (if (equal? (body-name view)
                                      (body-name (cadr (contact-bodies (car contacts)))))
                              1 -1)
                          (contact-torque (car contacts))))))))
(define (steady period torque reach)
  (lambda (time view other)
    (let ((turn (modulo (count-up! view) 4)))
      (set! (applied-force view)
            (against (if (= turn 2) (net-contact-force view #:from other) #(0 0 0)) torque))
      (set! (applied-torque view)
            (against (case turn
                       ((1) (rotate (orientation view) (gyro view)))
                       ((3) (felt-torque view other))
                       (else #(0 0 0)))
                     (* torque reach))))))
(define (strain name)
  (lambda (period torque reach)
    (lambda (time view)
      (let* ((count (count-up! view))
             (felt (if (odd? count) (joint-force view name) (joint-moment view name)))
             (sum (apply + (vector->list felt)))
             (new (vector-copy (joint-torques view)))
             (servo* (and (zero? (modulo count 3)) (servo-at view name))))
        (vector-set! new (1- (vector-length new)) (if (> sum 0) (- torque) torque))
        (set! (joint-torques view) new)
        (when servo*
          (set! (joint-servo view name)
                (servo #:target (- (servo-target servo*))
                       #:target-velocity (servo-target-velocity servo*)
                       #:stiffness (servo-stiffness servo*) #:damping (servo-damping servo*)
                       #:max-torque (servo-max-torque servo*))))))))
;; #f where there is none, or no joint that could have one
(define (servo-at view name)
  (catch 'timewarp-error (lambda () (joint-servo view name)) (const #f)))
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

std::string forces_text(const DescribedScene& scene) {
  std::string all;
  for (const DescribedForce& force : scene.forces) {
    const std::string body = body_text(force.body);
    if (force.linear > 0 || force.quadratic > 0)
      all += "(add-drag! " + body + " #:linear " + show(force.linear) + " #:quadratic " +
             show(force.quadratic) + ")\n";
    if (force.procedure)
      all += "(add-force! " + body + "\n  (lambda (time view)\n    (values (v+ (v* " +
             show(force.stiffness) + " (v- " + text(force.place) + " (position view)))\n" +
             "                (v* (sin (* " + show(2 * pi / force.period) + " time)) " +
             text(force.push) + "))\n            (v* " + show(-force.resistance) +
             " (angular-velocity view)))))\n";
  }
  return all;
}

std::string servos_text(const DescribedScene& scene) {
  std::string all;
  for (const DescribedServo& servo : scene.servos) {
    const auto slash = servo.link.find('/');
    all += "(set! (joint-servo (find-multibody \"" + servo.link.substr(0, slash) + "\") '" +
           servo.link.substr(slash + 1) + ")\n  (servo #:target " + show(servo.target) +
           " #:target-velocity " + show(servo.rate) + " #:stiffness " + show(servo.stiffness) +
           " #:damping " + show(servo.damping) + " #:max-torque " + show(servo.max_torque) + "))\n";
  }
  return all;
}

namespace {

// How a deed is called; `strain` by its last link.
std::string deed_text(const DescribedScene& scene, const DescribedCallback& callback) {
  if (callback.deed != Deed::strain) return name_of(callback.deed);
  const std::string& first = callback.targets.front();
  const std::string multibody = first.substr(0, first.find('/') + 1);
  std::string last;
  for (const DescribedBody& body : scene.bodies)
    if (body.name.starts_with(multibody)) last = body.name.substr(multibody.size());
  return "(strain '" + last + ")";
}

}  // namespace

std::string callbacks_text(const DescribedScene& scene) {
  if (scene.callbacks.empty()) return {};
  std::string all = deeds_text;
  for (const DescribedCallback& callback : scene.callbacks) {
    std::string targets;
    for (const std::string& name : callback.targets)
      targets += (targets.empty() ? "" : " ") + body_text(name);
    all += "(add-callback! (list " + targets + ") (" + deed_text(scene, callback) + " " +
           show(callback.period) + " " + show(callback.torque) + " " + show(callback.reach) +
           ") #:start " + show(callback.start) +
           (callback.deed == Deed::grip ? "" : " #:period " + show(callback.period)) + ")\n";
  }
  return all;
}

}  // namespace tw::fuzz
