#!/bin/sh
# The paper's table 1 on standard output: what its four simulations take, one run each, on one thread.
#
#   table1.sh SOURCE TIMEWARP...
#
# SPDX-License-Identifier: LGPL-3.0-or-later
source=$1
shift
echo "| | s | moving bodies | discontinuities | between them, ms | integration step, ms | integrations | integrated a body, s | rolled back a body, s | CPU, ms a frame |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
while read -r name seconds options; do
  # shellcheck disable=SC2086
  "$@" --quiet --stats --threads=1 --until="$seconds" $options "$source/scenes/$name.scm" \
    </dev/null 2>/dev/null | awk -v name="$name" -v seconds="$seconds" '
      { value[$1] = $2 }
      END {
        printf "| %s | %s | %d | %.1f k | %.2f | %.1f | %.3f M | %.1f (%+.1f %%) | %.4f | %.2f |\n", name, seconds,
          value["bodies_moving"], value["discontinuities"] / 1e3,
          1e3 * value["avg_time_between_discontinuities"], 1e3 * value["avg_integration_step"],
          value["integrations"] / 1e6, value["integration_per_moving_body"],
          100 * (value["integration_per_moving_body"] / seconds - 1),
          value["rollback_per_moving_body"], 1e3 * value["cpu_seconds_per_frame"]
      }' || exit 1
done <<END
atoms 120
cars 60 --accuracy=1e-5
robots 120 --accuracy=1e-4
avalanche 45
END
