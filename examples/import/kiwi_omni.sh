#!/bin/sh
# The lifted wheels of a real three-wheel omni robot (MaverickST/mobile-robot-estimation-suite, MIT) as three datasets.
#
#   examples/import/kiwi_omni.sh RECORDINGS OUT [PROGRAM]        RECORDINGS: the folder with lifted_1.csv and lifted_2.csv
#
# What does not fit: drive_*, rotation_* and video_* are of three wheels on the floor, and rig "robot" has four. The heading
# and the accelerometer of the lifted runs stand still and are left out.
set -eu
here=$(dirname "$0")
for wheel in 1 2 3; do
  "${3:-omnihil}" import "$1/lifted_1.csv" --holdout "$1/lifted_2.csv" --model "$here/kiwi_wheel.toml" \
    --map "t=time:s" --map "u$wheel=duty:%" --map "w$wheel=velocity:rad/s" \
    --title "wheel $wheel of a kiwi robot, lifted" --out "$2/wheel_$wheel"
done
