;;; A brick that tumbles in flight for 10 s: what figure 2 of the paper integrates.
(use-modules (timewarp))

(scene #:title "Brick" #:duration 10)

(add-body! #:name "brick" #:shape (box 0.2 0.1 0.06) #:position #(0 0 0) #:velocity #(3 0 20)
           #:angular-velocity #(2 5 1))
