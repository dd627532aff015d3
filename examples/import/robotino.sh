#!/bin/sh
# A real three-wheel omni robot on two floors on which its wheels slip (BrOleg5/research-wheel-slippage, Apache-2.0): a Festo
# Robotino, straight drives in twelve directions, commanded velocities, wheel speeds, currents and a camera above, 32 rows a second.
#
#   examples/import/robotino.sh RECORDINGS OUT [PROGRAM]      RECORDINGS: datasets/…/one_surface_type of the authors' repository
#
# Speeds are the motors': 16 turns for one of the wheel. Currents are logged without a sign: they get that of the speed.
# The camera counts pixels, y down and x to the right, where the bench has x up and y to the left.
set -eu
here=$(dirname "$0")
program=${3:-omnihil}
from=$1 out=$2
signed=$(mktemp -d)
trap 'rm -r "$signed"' EXIT
dataset() {  # dataset FLOOR FIT HOLDOUT EXTRAPOLATION: numbers of the authors' plan
  floor=$1 fit=$2 holdout=$3 extrapolation=$4
  mkdir "$signed/$floor"
  for n in $fit $holdout $extrapolation; do
    awk -F';' -v OFS=';' 'NR > 3 { for (i = 14; i <= 16; i++) if ($(i - 3) < 0) $i = -$i } { print }' \
      "$from/${floor}_surface/exp$n.csv" >"$signed/$floor/$n.csv"
  done
  names() { for n in $1; do printf '%s/%s/%s.csv\n' "$signed" "$floor" "$n"; done; }
  set --
  [ -z "$extrapolation" ] || set -- --extrapolation $(names "$extrapolation")
  "$program" import $(names "$fit") --holdout $(names "$holdout") "$@" --model "$here/robotino.toml" --out "$out/$floor" \
    --title "Robotino on the $floor floor" --map "Time=time:ms" \
    --map "Set robot speed along X axis=command_vx:m/s" --map "Set robot speed along Y axis=command_vy:m/s" \
    --map "Set rotational robot velocity=command_w:rad/s" \
    --map "1st motor velocity=wheel_speed_1:0.0625*rad/s" --map "2nd motor velocity=wheel_speed_2:0.0625*rad/s" \
    --map "3rd motor velocity=wheel_speed_3:0.0625*rad/s" \
    --map "1st motor current=motor_current_1:A" --map "2nd motor current=motor_current_2:A" \
    --map "3rd motor current=motor_current_3:A" \
    --map "Y axis global position=vision_x:-0.0018372*m" --map "X axis global position=vision_y:-0.0018405*m" \
    --map "Angle=vision_theta:deg"
}
dataset gray "00 12 24 72 84 96" "06 18 30 78 90" "144 150" # 0.1 and 0.2 m/s; in other directions; 0.3 m/s
dataset brown "00 12 24 30 42 54" "06 18 36 48" ""           # 0.1 m/s
