#!/bin/sh
# A real three-wheel omni robot (MaverickST/mobile-robot-estimation-suite, MIT) as five datasets: its lifted wheels one by one,
# the whole robot on the floor, driven by its duties ("robot"), and again by its commanded velocities alone ("commanded").
#
#   examples/import/kiwi_omni.sh RECORDINGS OUT [PROGRAM]        RECORDINGS: the folder with the authors' CSV files
#
# The robot's heading is its IMU's, which counts clockwise: "-rad". The video's places are put on the robot's clock by what
# the wheels say; its phi_rad is the direction of its path and no heading, and is left out. Left out as well: the
# accelerometer, which leans with the robot. rotation_1 turns without a command in its log: it has no place in "commanded".
set -eu
here=$(dirname "$0")
program=${3:-omnihil}
for wheel in 1 2 3; do
  "$program" import "$1/lifted_1.csv" --holdout "$1/lifted_2.csv" --model "$here/kiwi_wheel.toml" \
    --map "t=time:s" --map "u$wheel=duty:%" --map "w$wheel=velocity:rad/s" \
    --title "wheel $wheel of a kiwi robot, lifted" --out "$2/wheel_$wheel"
done
cat "$here/kiwi_robot.toml" "$here/kiwi_controller.toml" >"$2/kiwi_commanded.toml"
from=$1 out=$2
whole() {  # whole NAME MODEL TITLE [more words of import]: the runs on the floor as one dataset
  name=$1 model=$2 title=$3
  shift 3
  set -- "$@" --map "t=time:s" --map "time_s=time:s" --map "x_m=vision_x:m" --map "y_m=vision_y:m" --map "phi_rad=-" \
    --map "alpha=vision_theta:-rad" --map "ax=-" --map "ay=-"
  for wheel in 1 2 3; do set -- "$@" --map "w$wheel=wheel_speed_$wheel:rad/s"; done
  for run in 1 2 3 4 5; do
    [ ! -e "$from/video_$run.csv" ] || set -- "$@" --pose "drive_$run=$from/video_$run.csv"
  done
  "$program" import "$from/drive_1.csv" "$from/drive_2.csv" "$from/drive_3.csv" \
    --holdout "$from/drive_4.csv" "$from/drive_5.csv" --model "$model" --title "$title" --out "$out/$name" "$@"
}
whole robot "$here/kiwi_robot.toml" "a kiwi robot on the floor, by its duties" --extrapolation "$from/rotation_1.csv" \
  --map "u1=duty_1:%" --map "u2=duty_2:%" --map "u3=duty_3:%"
whole commanded "$2/kiwi_commanded.toml" "a kiwi robot on the floor, by its commanded velocities" \
  --map "vbx_sp=command_vx:m/s" --map "vby_sp=command_vy:m/s" --map "wb_sp=command_w:rad/s"
rm "$2/kiwi_commanded.toml"
