# One hash of a scene over everything that may not matter: output, frame rate, validators, pieces, GVT,
# windows, undoing, threads, and adversary schedulers.  Read by tests that set
#   scene, parameters   the scene's file and its options
#   seconds, seeds      how long, and how many adversaries of two kinds
#   ahead, spread       head starts of bodies and of every event, s
#   checked             seconds under --check, whose validators run after every event
# SPDX-License-Identifier: LGPL-3.0-or-later
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

# hash OPTION...: the last line of the run's output
hash_of() {
  "$TIMEWARP" "$scene" --until="$seconds" $parameters --hash --quiet --stats="$folder/stats.json" "$@" \
    >"$folder/out" 2>"$folder/err" || { cat "$folder/err"; return 1; }
  tail -n 1 "$folder/out"
}

# same NAME OPTION...: the hash must be that of the plain run
same() {
  name=$1
  shift
  found=$(hash_of "$@")
  rollbacks=$(sed -n 's/.*"rollbacks": *\([0-9]*\).*/\1/p' "$folder/stats.json")
  if [ "$found" = "$plain" ]; then
    echo "ok   $name (rollbacks: $rollbacks)"
  else
    echo "FAIL $name: $found, expected $plain"
    failures=$((failures + 1))
  fi
}

plain=$(hash_of) || exit 1
[ ${#plain} = 64 ] || { echo "no hash: $plain"; exit 1; }
echo "     $plain"

for fps in 24 30 1000; do
  same "poses at $fps fps" --fps=$fps --poses="$folder/poses.csv"
done
same "events" --events="$folder/events.csv"
same "seven pieces" --pieces=7
same "GVT at every event" --gvt-interval=1
same "GVT every 10,000 events" --gvt-interval=10000
same "small windows" --window=0.1
same "large windows" --window=3
same "undo and redo" --undo-redo
for threads in 1 2 3 8; do
  same "threads: $threads" --threads=$threads
done
same "threads: 3, undo and redo" --threads=3 --undo-redo
if "$TIMEWARP" --version | grep -q '^drawing: OSMesa'; then
  same "drawn" --frames="$folder/frames" --fps=5 --size=160x90 --quality=draft
fi

seed=1
rolled_back=0
while [ $seed -le "$seeds" ]; do
  same "adversary $seed, bodies ahead" --adversary=$seed,$ahead
  rolled_back=$((rolled_back + rollbacks))
  same "adversary $seed, every event" --adversary=$seed,$spread,every --threads=$((seed % 3 + 1))
  rolled_back=$((rolled_back + rollbacks))
  seed=$((seed + 1))
done
[ $rolled_back -gt 0 ] || { echo "FAIL the adversary never rolled back"; failures=$((failures + 1)); }

seconds=$checked
plain=$(hash_of)
same "validators, $seconds s" --check
exit $((failures > 0))
