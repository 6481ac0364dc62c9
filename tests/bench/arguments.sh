# Sourced by scripts that are called as NAME SOURCE TIMEWARP... [-- REST...]: $source, $command, and the rest as
# the arguments.
# SPDX-License-Identifier: LGPL-3.0-or-later
# shellcheck shell=sh disable=SC2034
source=$1
shift
command=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  command="$command $1"
  shift
done
[ $# -gt 0 ] && shift
