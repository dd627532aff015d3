#!/bin/sh
# A real three-wheel omni robot (MaverickST/mobile-robot-estimation-suite, MIT) as four datasets: its lifted wheels one by one,
# and the whole robot on the floor, driven by its duties.
#
#   examples/import/kiwi_omni.sh RECORDINGS OUT [PROGRAM]        RECORDINGS: the folder with the authors' CSV files
#
# The robot's heading is its IMU's, which counts clockwise: "-rad". The video's places are put on the robot's clock by what
# the wheels say; its phi_rad is the direction of its path and no heading, and is left out. Left out as well: the
# accelerometer, which leans with the robot, and the commanded velocities (they drive the model instead of the duties where
# u1 … u3 are left out and the model has a [controller]).
set -eu
here=$(dirname "$0")
program=${3:-omnihil}
for wheel in 1 2 3; do
  "$program" import "$1/lifted_1.csv" --holdout "$1/lifted_2.csv" --model "$here/kiwi_wheel.toml" \
    --map "t=time:s" --map "u$wheel=duty:%" --map "w$wheel=velocity:rad/s" \
    --title "wheel $wheel of a kiwi robot, lifted" --out "$2/wheel_$wheel"
done
set -- "$1" "$2" --model "$here/kiwi_robot.toml" --title "a kiwi robot on the floor, by its duties" --out "$2/robot" \
  --map "t=time:s" --map "time_s=time:s" --map "x_m=vision_x:m" --map "y_m=vision_y:m" --map "phi_rad=-" \
  --map "alpha=vision_theta:-rad" --map "ax=-" --map "ay=-"
for wheel in 1 2 3; do set -- "$@" --map "u$wheel=duty_$wheel:%" --map "w$wheel=wheel_speed_$wheel:rad/s"; done
for run in 1 2 3 4 5; do
  [ ! -e "$1/video_$run.csv" ] || set -- "$@" --pose "drive_$run=$1/video_$run.csv"
done
from=$1
shift 2
"$program" import "$from/drive_1.csv" "$from/drive_2.csv" "$from/drive_3.csv" \
  --holdout "$from/drive_4.csv" "$from/drive_5.csv" --extrapolation "$from/rotation_1.csv" "$@"
