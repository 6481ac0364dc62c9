;; JSON at the border: what is read and written, and that one is the other's inverse.
;; SPDX-License-Identifier: LGPL-3.0-or-later
(load "helpers.scm")

(test-begin "json")

(define data
  '(("a" . 1) ("b" . #(0.1 -2.5e-7 1e300)) ("c" . (("d" . "it's \"quoted\", \\ and\nü")))
    ("e" . #t) ("f" . #f) ("g" . null) ("h" . ()) ("i" . #()) ("big" . 9007199254740993)))

(test-equal "what is written is read as it was" data (%read-json (%write-json data)))
(test-assert "in one line" (not (string-index (%write-json data) #\newline)))
(test-equal "objects keep their order" "{\"z\":1,\"a\":{}}" (%write-json '(("z" . 1) ("a" . ()))))
(test-equal "numbers as other programs write them" '(("x" . 1e-7) ("y" . 100.0))
  (%read-json "{\"x\": 1e-07, \"y\": 1E+2}"))
(test-equal "what is not finite becomes null" "[null,null]" (%write-json (vector +inf.0 (nan))))
(test-equal "rational numbers are written as decimal ones" "0.5" (%write-json 1/2))
(test-message "no JSON" "the JSON text is .*; expected valid JSON" (%read-json "{\"a\": "))
(test-message "an object that is none" "an entry of a JSON object is 1; expected a pair"
  (%write-json '(1 2)))

(test-end "json")
