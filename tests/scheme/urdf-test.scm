;; Robots from URDF files.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(use-modules (srfi srfi-1) (srfi srfi-64) (timewarp) (timewarp vectors))
(load "helpers.scm")

(test-begin "urdf")

(define here (dirname (canonicalize-path (current-filename))))
(define (file name) (string-append here "/../data/urdf/" name))

(define (replaced text from to)
  (let ((at (string-contains text from)))
    (unless at (error "the test's file has no" from))
    (string-append (substring text 0 at) to (substring text (+ at (string-length from))))))

;; a copy of the robot and its meshes, with TO instead of FROM
(define (changed from to)
  (system* "cp" "-r" (file "") (in-folder "urdf"))
  (write-file "urdf/changed.urdf"
    (replaced (call-with-input-file (file "arm.urdf") get-string-all) from to)))

(in-world ()
  (let ((arm (load-urdf (file "arm.urdf") #:position #(1 0 0))))
    (test-equal "it is called as in the file" "arm" (multibody-name arm))
    (test-equal "joints are called as the links they move" '(pan tilt slide) (joint-names arm))
    (test-equal "limits" '(-1.0 0.5) (joint-limits arm 'tilt))
    (test-equal "none of what goes round" '(-inf.0 +inf.0) (joint-limits arm 'pan))
    (test-assert "what has no mass and is fixed to the base stands"
      (close? #(1 0 0) (position (find-body "arm/stand")) 1e-12))
    (test-assert "the pan joint" (close? #(1 0 0.55) (position (link-body arm 'pan)) 1e-12))
    ;; turned by 0.5 about z there
    (let ((c (cos 0.5)) (s (sin 0.5)))
      (test-assert "the slide, half a metre along the tilted link"
        (close? (vector (+ 1 (* 0.5 c)) (* 0.5 s) 0.7) (position (link-body arm 'slide)) 1e-12))
      ;; as the tensor of tilt is turned by 90 degrees about z, its long axis lies along x
      (test-assert "gravity at the tilt joint, by hand"
        (close? (- (* 9.81 (+ (* 1.5 0.25) (* 0.5 0.5))))
                (vector-ref (inverse-dynamics arm #(0 0 0) #(0 0 0) #(0 0 0)) 1) 1e-9))
      (test-assert "the tilt's inertia about its joint, by hand"
        (close? (+ 0.05 (* 1.5 0.25 0.25) 0.003 (* 0.5 0.25))
                (- (vector-ref (inverse-dynamics arm #(0 0 0) #(0 0 0) #(0 1 0)) 1)
                   (vector-ref (inverse-dynamics arm #(0 0 0) #(0 0 0) #(0 0 0)) 1))
                1e-9)))
    (run! #:until 2)
    (test-approximate "it falls onto its stop" 0.5 (joint-position arm 'tilt) 0.02)))

(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((arm (load-urdf (file "arm.urdf") #:name 'two #:base (add-body! #:name "table" #:fixed? #t
                                                              #:shape (box 1 1 1))
                        #:position #(0 0 0.5) #:orientation (rotation #(0 0 1) 1))))
    (test-assert "on a body, at a place in its frame"
      (close? #(0 0 1.05) (position (link-body arm 'pan)) 1e-12))
    (test-message "a name twice" "name two/stand is taken"
      (load-urdf (file "arm.urdf") #:name 'two))
))

;; the hull of the tool's mesh is a part of the slide
(in-world ()
  (let* ((arm (load-urdf (file "arm.urdf")))
         (slide (link-body arm 'slide)))
    (add-body! #:name "ball" #:shape (sphere 0.01) #:density 1000
               #:position (v+ (position slide) (rotate (orientation slide) #(0.175 0.02 0.02))))
    (test-message "in the tool" "ball overlap" (run! #:until 0.1))))
;; what is only seen is not touched
(in-world ()
  (let* ((arm (load-urdf (changed "<collision><origin xyz=\"0.05 0 0\"/>
      <geometry><mesh filename=\"meshes/tetra.stl\"/></geometry></collision>" "")))
         (slide (link-body arm 'slide)))
    (test-assert "a file with visuals alone" (multibody? arm))))

;; what is fixed to a free robot before its first mass is a part of that
(in-world ()
  (let* ((arm (load-urdf (changed "type=\"continuous\"" "type=\"fixed\"") #:base 'free
                         #:position #(0 0 5)))
         (pan (link-body arm 'pan)))
    (add-body! #:name "ball" #:shape (sphere 0.01) #:density 1000
               #:position (v+ (position pan) #(0.05 0 -0.3)))
    (test-message "the stand hangs under it" "ball overlap" (run! #:until 0.1))))

;; ---- what cannot be ----

(define-syntax-rule (refused name from to pattern)
  (in-world ()
    (let ((file (changed from to)))
      (test-message name pattern (load-urdf file)))))

(in-world ()
  (test-message "no file" "the URDF file nowhere.urdf is missing" (load-urdf "nowhere.urdf"))
  (test-message "a first link without mass" "moves the first link|has no mass"
    (load-urdf (file "arm.urdf") #:base 'free)))
(refused "not well-formed" "<link name=\"pan\">" "<link name=\"pan\""
         "changed.urdf:[0-9]+: .*; expected well-formed XML")
(refused "a planar joint" "type=\"continuous\"" "type=\"planar\""
         "changed.urdf:14: the joint pan_joint is planar; expected fixed, revolute, continuous or prismatic")
(refused "mimic" "<dynamics damping=\"0.5\" friction=\"0.1\"/>" "<mimic joint=\"tilt_joint\"/>"
         "changed.urdf:14: the joint pan_joint is driven by another one")
(refused "a mesh that is missing" "meshes/tetra.stl" "meshes/none.stl"
         "changed.urdf:42: <mesh> of the link tool: the mesh .*none.stl is missing")
(refused "a moving link without mass" "type=\"fixed\"" "type=\"continuous\""
         "changed.urdf:40: the link tool has no mass and is moved by the joint tool_joint")
(refused "a negative mass" "<mass value=\"2\"/>" "<mass value=\"-2\"/>"
         "changed.urdf:9: the mass of the link pan is -2")
(refused "links that hang on each other" "<parent link=\"stand\"/>" "<parent link=\"slide\"/>"
         "does not hang on the root, stand")
(refused "an inertia that no body has" "izz=\"0.01\"" "izz=\"0.1\""
         "changed.urdf:10: the <inertia> of the link pan has the principal moments 0.02, 0.02, 0.1 kg")
(refused "a parent that is not there" "<parent link=\"tilt\"/>" "<parent link=\"nix\"/>" "nix")

(clean-up)
(test-end "urdf")
