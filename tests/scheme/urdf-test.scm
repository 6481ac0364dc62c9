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
    (test-equal "joints are called as in the file" '(pan_joint tilt_joint slide_joint)
      (joint-names arm))
    (test-equal "limits" '(-1.0 0.5) (joint-limits arm 'tilt_joint))
    (test-equal "by the link that it moves, too" '(-1.0 0.5) (joint-limits arm 'tilt))
    (test-equal "effort" 100.0 (joint-max-torque arm 'tilt_joint))
    (test-equal "a servo has it" 100.0
      (begin (set! (joint-servo arm 'tilt_joint) (servo #:stiffness 0 #:damping 0 #:target 0.1))
             (set! (joint-servo arm 'tilt_joint) (servo #:stiffness 1))
             (let ((most (servo-max-torque (joint-servo arm 'tilt_joint))))
               (set! (joint-servo arm 'tilt_joint) #f)
               most)))
    (test-equal "velocity" 3.0 (joint-max-velocity arm 'tilt))
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

;; ---- what is mended ----

(define (robot . lines)
  (apply write-file "robot.urdf" `("<robot name=\"bot\">" ,@lines "</robot>")))
(define* (link-text name #:key (mass 1) (moments '(1 1 1)) (more ""))
  (format #f "<link name=\"~a\"><inertial><mass value=\"~a\"/><inertia ixx=\"~a\" iyy=\"~a\" izz=\"~a\"/>\
</inertial>~a</link>" name mass (first moments) (second moments) (third moments) more))
(define* (joint-text name parent child #:key (type "revolute") (axis "0 0 1") (at "0 0 0")
                     (more "<limit lower=\"-2\" upper=\"2\"/>"))
  (format #f "<joint name=\"~a\" type=\"~a\"><parent link=\"~a\"/><child link=\"~a\"/>\
<origin xyz=\"~a\"/><axis xyz=\"~a\"/>~a</joint>" name type parent child at axis more))
(define a-box "<collision><geometry><box size=\"0.2 0.2 0.2\"/></geometry></collision>")

;; the robot, and what was warned of
(define (loaded . arguments)
  (let ((robot #f))
    (let ((warned (call-with-output-string
                   (lambda (port)
                     (parameterize ((current-warning-port port))
                       (set! robot (apply load-urdf arguments)))))))
      (values robot warned))))

(define-syntax-rule (mended name (pattern ...) (made warned) file body ...)
  (in-world ()
    (let ((path file))
      (call-with-values (lambda () (loaded path))
        (lambda (made warned)
          (test-assert (format #f "~a is told: ~a" name warned)
            (and (string-match pattern warned) ...))
          body ...)))
    (test-message (string-append name ", but not if strict") ".*" (load-urdf file #:strict? #t))))

(define (inertia-of joint robot)
  (vector-ref (inverse-dynamics robot #(0) #(0) #(1)) 0))

(mended "inertia that no body has" ("robot.urdf:3: the <inertia> of the link arm has the principal moments 1, 1, 5 .* they are 2, 2, 4")
    (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm #:moments '(1 1 5)) (joint-text 'j 'base 'arm))
  (test-approximate "the trace stays" 4 (inertia-of 'j bot) 1e-12))
(mended "inertia of 0" ("robot.urdf:3: .*it is that of its shapes") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm #:moments '(0 0 0) #:mass 3 #:more a-box)
           (joint-text 'j 'base 'arm))
  (test-approximate "of the box" (* 3 0.04 1/6) (inertia-of 'j bot) 1e-12))
(mended "no <inertia>" ("robot.urdf:3: the link arm has no <inertia>; it is that of its shapes")
    (bot warned)
    (robot "<link name=\"base\"/>"
           (format #f "<link name=\"arm\"><inertial><mass value=\"3\"/></inertial>~a</link>" a-box)
           (joint-text 'j 'base 'arm))
  (test-approximate "of the box again" (* 3 0.04 1/6) (inertia-of 'j bot) 1e-12))
(mended "no mass that moves" ("robot.urdf:3: the link between moves, and has no mass; it has 0.001 kg")
    (bot warned)
    (robot "<link name=\"base\"/>" "<link name=\"between\"/>" (link-text 'arm)
           (joint-text 'j 'base 'between) (joint-text 'k 'between 'arm #:axis "1 0 0"))
  (test-equal "both joints" '(j k) (joint-names bot)))
(mended "limits of 0" ("robot.urdf:4: the limits of the joint j are not given, and so 0 and 0; it is locked")
    (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm)
           (joint-text 'j 'base 'arm #:more "<limit effort=\"1\"/>")
           (link-text 'hand) (joint-text 'k 'arm 'hand))
  (test-equal "one joint moves" '(k) (joint-names bot)))
(mended "a joint locked away from 0" ("the limits of the joint j are 1 and 1") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm)
           (joint-text 'j 'base 'arm #:type "prismatic" #:more "<limit lower=\"1\" upper=\"1\"/>")
           (link-text 'hand) (joint-text 'k 'arm 'hand))
  (test-assert "is there" (close? #(0 0 1) (position (link-body bot 'hand)) 1e-12)))
(mended "limits in the wrong order" ("are 1 and -1; it has none") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm)
           (joint-text 'j 'base 'arm #:more "<limit lower=\"1\" upper=\"-1\"/>"))
  (test-equal "none" '(-inf.0 +inf.0) (joint-limits bot 'j)))
(mended "a visual that cannot be read" ("robot.urdf:3: radius of <sphere> is -1; the <visual> is left out")
    (bot warned)
    (robot "<link name=\"base\"/>"
           (link-text 'arm #:more "<visual><geometry><sphere radius=\"-1\"/></geometry></visual>")
           (joint-text 'j 'base 'arm)))
(mended "numbers with commas" ("xyz of <origin> is \"1,0,0\"; it is 1 0 0") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm) (joint-text 'j 'base 'arm #:at "1,0,0"))
  (test-assert "read" (close? #(1 0 0) (position (link-body bot 'arm)) 1e-12)))
(mended "what is not understood" ("robot.urdf:3: the link arm has <colision>; it is left out" "robot.urdf:2: <robot> has <Link>")
    (bot warned)
    (robot "<link name=\"base\"/><Link/>" (link-text 'arm #:more "<colision/>") (joint-text 'j 'base 'arm)))
(mended "a colour that is none" ("robot.urdf:2: rgba of <color> is \"red\"; it is left out") (bot warned)
    (robot "<material name=\"m\"><color rgba=\"red\"/></material>" "<link name=\"base\"/>" (link-text 'arm) (joint-text 'j 'base 'arm)))
(mended "a follower of what does not move" ("the joint k follows j, which does not move; it is locked at 0.5") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'a) (link-text 'b) (link-text 'c)
           (joint-text 'j 'base 'a #:type "fixed") (joint-text 'i 'base 'c)
           (joint-text 'k 'a 'b #:more "<mimic joint=\"j\" offset=\"0.5\"/>"))
  (test-equal "one moves" '(i) (joint-names bot)))
(mended "a planar joint" ("the joint j is planar; it is two slides, j/x and j/y") (bot warned)
    (robot "<link name=\"base\"/>" (link-text 'arm) (joint-text 'j 'base 'arm #:type "planar"))
  (test-equal "three" '(j/x j/y j) (joint-names bot)))

(in-world ()
  (let ((box (load-urdf (robot (link-text 'base #:more a-box)))))
    (test-equal "one link is free" 'base (car (joint-names box)))
    (run! #:until 1)
    (test-approximate "and falls" (* -1/2 9.81) (vector-ref (position box) 2) 1e-9)))
(in-world ()
  (let ((ground (load-urdf (robot (format #f "<link name=\"ground\">~a</link>" a-box)))))
    (test-equal "what has no mass is a fixed body" "bot" (body-name ground))
    (let ((ball (add-body! #:shape (sphere 0.1) #:position #(0 0 0.3))))
      (run! #:until 2)
      (test-approximate "that carries" 0.2 (vector-ref (position ball) 2) 1e-3)))
  (test-equal "the same again has a number" "bot-2" (body-name (load-urdf (in-folder "robot.urdf")))))
(in-world ()
  (let ((bot (load-urdf (robot "<link name=\"world\"/>" (link-text 'trunk)
                               (joint-text 'float 'world 'trunk #:type "floating")
                               (link-text 'arm) (joint-text 'j 'trunk 'arm)))))
    (test-equal "a robot that floats in an empty root is free" '(trunk j) (joint-names bot))))

;; links 1 and 3 overlap, neighbours of 2 both
(define (three-boxes first)
  (robot first (link-text 'two #:more a-box) (link-text 'three #:more a-box)
         (joint-text 'j 'one 'two #:at "0.1 0 0") (joint-text 'k 'two 'three #:at "0 0.1 0")))
(define (overlapping name first pattern)
  (in-world ()
    (call-with-values (lambda () (loaded (three-boxes first)))
      (lambda (bot warned)
        (test-assert (format #f "~a: ~a" name warned) (string-match pattern warned))
        (run! #:until 0.1)))))
(overlapping "links that overlap at the start" (link-text 'one #:more a-box)
             "bot/one and bot/three overlap by 0.1.* do not touch each other")
(overlapping "one that overlaps what stands" (format #f "<link name=\"one\">~a</link>" a-box)
             "bot/one and bot/three|bot/three and bot/one")
(in-world ()
  (call-with-values
      (lambda () (loaded (three-boxes (link-text 'one #:more a-box)) #:self-collisions? #f))
    (lambda (bot warned) (test-equal "none of them touch" "" warned))))

;; ---- scenery of meshes ----

(write-file "ell.obj" "o bracket"
            "v 0 0 0" "v 2 0 0" "v 2 1 0" "v 1 1 0" "v 1 2 0" "v 0 2 0"
            "v 0 0 1" "v 2 0 1" "v 2 1 1" "v 1 1 1" "v 1 2 1" "v 0 2 1"
            "f 6 5 4 3 2 1" "f 7 8 9 10 11 12"
            "f 1 2 8 7" "f 2 3 9 8" "f 3 4 10 9" "f 4 5 11 10" "f 5 6 12 11" "f 6 1 7 12")
(write-file "sheet.obj" "v -5 -5 0" "v 5 -5 0" "v 5 5 0" "v -5 5 0" "f 1 2 3 4")
(define (mesh-text file scale at)
  (format #f "<collision><origin xyz=\"~a\"/><geometry><mesh filename=\"~a\" scale=\"~a\"/></geometry></collision>"
          at file scale))
;; where a ball that falls at x, y ends, m
(define (ends-at x y . pieces)
  (in-world ()
    (scene #:gravity #(0 0 -9.81))
    (loaded (robot (format #f "<link name=\"ground\">~a</link>" (string-concatenate pieces))))
    (let ((ball (add-body! #:shape (sphere 0.1) #:position (vector x y 2.2))))
      (run! #:until 2)
      (vector-ref (position ball) 2))))
(test-assert "concave meshes are scenery as they are"
  (let ((ell (mesh-text "ell.obj" "1 1 1" "0 0 1")))
    (and (close? (ends-at 0.5 0.5 ell) 2.1 1e-3) (< (ends-at 1.5 1.5 ell) -5))))
;; seen from inside, without a lid
(write-file "tray.obj" "v 0 0 0" "v 2 0 0" "v 2 2 0" "v 0 2 0" "v 0 0 1" "v 2 0 1" "v 2 2 1" "v 0 2 1"
            "f 1 2 3 4" "f 1 5 6 2" "f 2 6 7 3" "f 3 7 8 4" "f 4 8 5 1")
(test-assert "a tray is no block"
  (close? (ends-at 1 1 (mesh-text "tray.obj" "1 1 1" "0 0 0")) 0.1 1e-3))
(test-assert "flat ones, too, and several are one"
  (let ((pieces (list (mesh-text "sheet.obj" "1 1 1" "0 0 0") (mesh-text "ell.obj" "1 1 1" "0 0 0"))))
    (and (close? (apply ends-at 1.5 1.5 pieces) 0.1 1e-3)
         (close? (apply ends-at 0.5 0.5 pieces) 1.1 1e-3))))
;; ---- joints that follow others ----

(in-world ()
  (scene #:gravity #(0 0 0))
  (let ((gears (load-urdf (robot "<link name=\"base\"/>" (link-text 'a #:moments '(2 2 2))
                                 (link-text 'b #:moments '(3 3 3)) (link-text 'c #:moments '(5 5 5))
                                 (joint-text 'ja 'base 'a #:more "<limit lower=\"-9\" upper=\"4\"/>")
                                 (joint-text 'jb 'base 'b #:at "1 0 0"
                                   #:more "<limit lower=\"-9\" upper=\"2\"/><mimic joint=\"ja\" multiplier=\"-2\" offset=\"1\"/>")
                                 (joint-text 'jc 'base 'c #:at "3 0 0" #:type "continuous"
                                   #:more "<mimic joint=\"jb\" multiplier=\"0.5\"/>")))))
    (test-equal "limits of both" '(-0.5 4.0) (joint-limits gears 'ja))
    (test-assert "followers begin where they belong" (close? #(0 1 0.5) (joint-positions gears) 1e-15))
    (test-approximate "inverse dynamics of all" 19
      (vector-ref (inverse-dynamics gears #(0 0 0) #(0 0 0) #(1 0 0)) 0) 1e-12)
    (set! (joint-torque gears 'ja) 1)
    (run! #:until 1)
    ;; inertia 2 + 4 3 + 1 5 at ja
    (let ((turned (/ 1/2 (+ 2 12 5))))
      (test-assert "one inertia of all"
        (close? (vector turned (- 1 (* 2 turned)) (- 1/2 turned)) (joint-positions gears) 1e-9)))
    (set! (joint-torque gears 'ja) 0)
    (set! (joint-velocity gears 'ja) 0.3)
    (test-assert "a leader set takes the others along"
      (close? #(0.3 -0.6 -0.3) (joint-velocities gears) 1e-15))
    (test-message "a follower is not set"
      "the velocity of joint jb of bot is 1; expected -0.6, as it follows ja: set that one"
      (set! (joint-velocity gears 'jb) 1))
    (let ((q (inverse-kinematics gears 'c #:position (vector (+ 3 (cos 1)) (- (sin 1)) 0)
                                 #:point #(1 0 0))))
      (test-assert "inverse kinematics" (and q (close? #(1.5 -2 -1) q 1e-8))))))

;; a ball on a finger that another one is geared to: what the blow does is exact, nothing is lost
(in-world ()
  (scene #:gravity #(0 0 0) #:accuracy 1e-8)
  (set-contact-parameters! #t #t #:restitution 1 #:friction 0)
  (let* ((finger "<collision><origin xyz=\"1 0 0\"/><geometry><box size=\"2 0.2 0.2\"/></geometry></collision>")
         (grip (load-urdf (robot "<link name=\"base\"/>" (link-text 'a #:moments '(2 2 2) #:more finger)
                                 (link-text 'b #:moments '(3 3 3))
                                 (joint-text 'ja 'base 'a #:type "continuous" #:more "")
                                 (joint-text 'jb 'base 'b #:at "0 5 0" #:type "continuous"
                                             #:more "<mimic joint=\"ja\" multiplier=\"2\"/>"))))
         (ball (add-body! #:shape (sphere 0.1) #:mass 1 #:position #(1 0.5 0) #:velocity #(0 -1 0)))
         (before (total-energy)))
    (run! #:until 0.35)
    ;; at the lever 1 the finger weighs 2 + 4 3 = 14: u = 2/(1 + 14)
    (test-approximate "the blow, by hand" -2/15 (joint-velocity grip 'ja) 1e-9)
    (test-approximate "the follower" -4/15 (joint-velocity grip 'jb) 1e-9)
    (test-approximate "no energy is lost" before (total-energy) 1e-9)))

;; ---- where meshes lie ----

(let ((file (robot (link-text 'base #:more "<collision><geometry><mesh filename=\"package://pack/tetra.STL\"/></geometry></collision>"))))
  (for-each (lambda (name) (mkdir (in-folder name))) (list "elsewhere" "elsewhere/pack"))
  (system* "cp" (string-append here "/../data/urdf/meshes/tetra.stl") (in-folder "elsewhere/pack/tetra.stl"))
  (in-world ()
    (test-message "not found" "robot.urdf:2: <mesh> of the link base: the mesh package://pack/tetra.STL is missing.*#:package-path"
      (load-urdf file)))
  (in-world ()
    (test-assert "in a folder of the path, capitals aside"
      (multibody? (load-urdf file #:package-path (in-folder "elsewhere")))))
  (in-world ()
    (test-assert "that is the package" (multibody? (load-urdf file #:package-path (list (in-folder "elsewhere/pack")))))))

;; ---- what cannot be ----

(define-syntax-rule (refused name from to pattern)
  (in-world ()
    (let ((file (changed from to)))
      (test-message name pattern (load-urdf file)))))

(in-world ()
  (test-message "no file" "the URDF file nowhere.urdf is missing" (load-urdf "nowhere.urdf"))
  (test-assert "free, with a stand that the first joint moves"
    (multibody? (load-urdf (file "arm.urdf") #:base 'free))))
(refused "not well-formed" "<link name=\"pan\">" "<link name=\"pan\""
         "changed.urdf:[0-9]+: .*; expected well-formed XML")
(refused "a mesh that is missing" "meshes/tetra.stl" "meshes/none.stl"
         "changed.urdf:42: <mesh> of the link tool: the mesh .*none.stl is missing")
(refused "a negative mass" "<mass value=\"2\"/>" "<mass value=\"-2\"/>"
         "changed.urdf:9: value of <mass> is -2")
(refused "links that hang on each other" "<parent link=\"stand\"/>" "<parent link=\"slide\"/>"
         "the link pan does not hang on the root, stand")
(refused "a parent that is not there" "<parent link=\"tilt\"/>" "<parent link=\"nix\"/>"
         "changed.urdf:35: the parent of the joint slide_joint is nix, which is no link")
(refused "macros deep inside" "<mass value=\"2\"/>" "<xacro:mass m=\"2\"/>"
         "changed.urdf:9: <xacro:mass> is a macro of xacro")
(refused "a collision that cannot be read" "<cylinder radius=\"0.1\" length=\"0.5\"/>"
         "<cylindre radius=\"0.1\" length=\"0.5\"/>"
         "changed.urdf:6: the geometry is <cylindre>; expected <box>, <sphere>")
(refused "two shapes in one" "<cylinder radius=\"0.1\" length=\"0.5\"/>"
         "<cylinder radius=\"0.1\" length=\"0.5\"/><sphere radius=\"1\"/>"
         "changed.urdf:6: <geometry> has <cylinder> and <sphere>; expected one")
(refused "macros" "<mass value=\"2\"/>" "<mass value=\"${2*m}\"/>"
         "changed.urdf:9: value of <mass> is .*a macro of xacro")
(refused "another root" "<robot name=\"arm\">" "<sdf name=\"arm\">" "changed.urdf:[0-9]+: ")

(clean-up)
(test-end "urdf")
