// What most sessions of tests are: robot 0 of a model, by the dongle of ulaval-hermes, in the closed form's mechanics.
//
//   SessionSetup setup = test::one_robot("omni_default");
#pragma once
#include <string>

#include "hil/loop/model_store.h"
#include "hil/recording/session_setup.h"

namespace omnihil::test {

inline SessionSetup one_robot(const std::string& model) {
  SessionSetup setup;
  setup.model = load_robot_model(model, {OMNIHIL_SOURCE_DIR "/models"}).bundle;
  setup.radio_format = "ulaval-hermes";
  setup.robot_ids = {0};
  setup.plant.physics = Physics::kPlanar;
  return setup;
}

}  // namespace omnihil::test
