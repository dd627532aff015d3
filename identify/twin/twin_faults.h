// The faults that a live twin knows by name: what each does to the model, and how large it has to be to be worth an alarm.
//
//   TwinBank bank = twin_bank(model);                     // the model with every fault in it, all of them neutral
//   bank.faults[1].suspect;                               // "torque of wheel 2"
//   bank.faults[1].size_text(-0.21, 0.03);                // "-21 % (-27 to -15 %)"
//
// A fault is a number of the model that a healthy robot has at its model's value: a row of an effect of the catalogue, a base
// parameter, or one of two laws that stand here because no fit may search for them (a wheel alone has no drag of its own in
// a catalogue that is the same for all wheels):
//   wheel torque   k_t = (1 + t_k) k_t of the winding, back-EMF as before: a slipping coupling, a winding that has come off
//   wheel drag     a level of friction that opposes rolling of wheel k and holds at zero
// Magnets that weaken take torque and back-EMF alike (motor_mismatch): the same suspect, since the same part is to be looked at.
// Sizes are of the parameter's own unit, away from the model's value. Cannot: faults that are no number of the model (a dead
// line: twin_watch.h), two at once (the larger is named).
#pragma once
#include <string>
#include <vector>

#include "identify/predict/candidate.h"

namespace omnihil {

struct TwinFault {
  std::string id;       // "wheel_torque_2", for programs
  std::string suspect;  // "torque of wheel 2"; faults of one suspect are not told apart
  Unknown unknown;      // in TwinBank::model
  double least =
      0.0;  // the smallest size worth an alarm, with its sign; a robot may get twice and four times as far
  bool percent = false;
  std::string unit;

  std::string size_text(double size, double sigma) const;  // with its 95 % interval
};

struct TwinBank {
  Candidate model;
  std::vector<TwinFault> faults;
  std::vector<Unknown> unknowns() const;
};

TwinBank twin_bank(const Candidate& model);

}  // namespace omnihil
