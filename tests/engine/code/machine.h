// Calls the program of one controller.
#pragma once

#include <string>

#include "engine/code/interpreter.h"

namespace tunewright::code {

class Machine : public Interpreter {
public:
    using Interpreter::Interpreter;

    double step(double r, double y, bool manual = false, double manual_output = 0) {
        (*this)["setpoint"] = r;
        (*this)["measurement"] = y;
        (*this)["manual"] = manual ? 1 : 0;
        (*this)["manual_output"] = manual_output;
        call();
        return (*this)["u"];
    }
};

}  // namespace tunewright::code
