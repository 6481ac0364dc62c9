;; (timewarp): everything that scenes use, gathered from the modules in timewarp/.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(define-module (timewarp))

(eval-when (expand load eval)
  (define public-modules
    '(((timewarp worlds)
       make-world current-world reset! scene scene-random-state world-time world-bodies find-body)
      ((timewarp parameters) define-scene-parameter)
      ((timewarp shapes))
      ((timewarp bodies))
      ((timewarp contact))
      ((timewarp queries)
       ray-cast hit? hit-body hit-point hit-normal hit-distance closest-points overlapping
       bounding-box all-poses)
      ((timewarp sensors))
      ((timewarp forces))
      ((timewarp multibodies)
       add-multibody! multibody? multibody-name multibody-links body-multibody link-body
       load-urdf find-multibody world-multibodies link link? joint? revolute prismatic universal spherical weld
       joint-names joint-limits joint-max-torque joint-max-velocity
       joint-position joint-velocity joint-torque joint-servo
       joint-positions joint-velocities joint-torques
       servo servo? servo-target servo-target-velocity servo-stiffness servo-damping
       servo-max-torque
       jacobian forward-kinematics inverse-kinematics inverse-dynamics)
      ((timewarp callbacks))
      ((timewarp running)
       run! run-for! step! statistics show-statistics state-queue checkpoint restore! total-energy total-momentum)
      ((timewarp looking))
      ((timewarp drawing) render!)
      ((timewarp simulate))
      ((timewarp loader) load-scene)))

  ;; the interface gets the variables themselves, so that a module's own set! is seen by all
  (let ((interface (module-public-interface (current-module))))
    (define (add! name variable)
      (module-add! interface name variable))
    (for-each
     (lambda (entry)
       (let ((source (resolve-interface (car entry))))
         (if (null? (cdr entry))
             (module-for-each add! source)
             (for-each (lambda (name) (add! name (module-variable source name))) (cdr entry)))
         ;; what takes the place of one of Guile's own
         (hash-for-each (lambda (name _)
                          (hashq-set! (module-replacements interface) name #t))
                        (module-replacements source))))
     public-modules)))
