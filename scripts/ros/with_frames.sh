#!/usr/bin/env bash
# Runs rviz with the frames of this namespace: "with_frames.sh PROGRAM ...". In uav1, frames begin
# with uav1/, which rviz only reads from its file.
set -euo pipefail

frames=${ROS_NAMESPACE:-}
frames=${frames#/}
[ -n "$frames" ] || exec "$@"
# The link names of RotorS' vehicles already contain the namespace.
links=$frames
if rosparam get -p robot_description | grep "<link name=\"$frames/" >/dev/null; then links=""; fi
copy=$(mktemp --suffix .rviz)
trap 'rm -f "$copy"' EXIT
arguments=()
for argument in "$@"; do
  if [[ $argument = *.rviz ]]; then
    sed -e "s|TF Prefix: .*|TF Prefix: $links|" -e "s|Target Frame: |&$frames/|" \
      -e "/world:/!s|[a-z0-9]*: {Value: |$frames/&|" "$argument" >"$copy"
    argument=$copy
  fi
  arguments+=("$argument")
done
"${arguments[@]}" &
trap 'kill -INT $!' INT TERM
wait || wait
