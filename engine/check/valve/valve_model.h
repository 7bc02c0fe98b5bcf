// Models of a valve that sticks: its position from the controller's output.
#pragma once

#include <span>
#include <vector>

namespace tunewright::check {

/// `band`: dead band and stick together, S; `jump`: by which it moves when it breaks loose, J; both in the unit of the
/// output. J = 0 is a backlash of width S.
struct ValveModel {
    enum class Kind {
        he,   ///< He, Wang, Pottmann and Qin 2007, Industrial and Engineering Chemistry Research 46, 4549
        kano  ///< Kano, Maruta, Kugemoto and Shimizu 2004, DYCOPS 7
    };
    Kind kind = Kind::he;
    double band = 0, jump = 0;
};

/// A valve that is moved row by row; at first its position is the output `at`.
class Valve {
public:
    Valve(const ValveModel& model, double at) : model_(model), position_(at), before_(at), stopped_at_(at) {}

    /// The position with the output u.
    double move(double u);

private:
    void move_he(double u);
    void move_kano(double u);

    ValveModel model_;
    double position_, before_;
    double stored_ = 0;  ///< He: the force that friction holds
    double stopped_at_;  ///< Kano: and its direction, the sign of the last move, whether it rests
    int direction_ = 1, last_ = 0;
    bool stopped_ = true;
};

/// The position in each row; at first it is the output's.
std::vector<double> valve_position(std::span<const double> output, const ValveModel& valve);

/// Valves of both kinds with bands from a twentieth of `span` to a little more than all of it, and four jumps of each.
std::vector<ValveModel> valve_candidates(double span);

}  // namespace tunewright::check
