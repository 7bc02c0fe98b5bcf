// A continuous region of plants around one: what is known when parameters are known within ranges or with covariance.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The plants whose parameters are centre + A z, z in the cube |z_i| <= 1 or in the ball |z| <= 1. Parameters go by
/// name: K, T, T1, T2, zeta, L, and a1, a2, a3, b of a `TransferFunction` (K b s + K)/(a3 s^3 + a2 s^2 + a1 s + 1),
/// perhaps over s. K of a transfer function is its numerator's last coefficient other than 0, which scales all of them;
/// of a state space a factor of C and D.
class PlantRegion {
public:
    using Point = std::vector<double>;

    /// The plant's own `uncertainty`: a cube; of dimension 0 if it has none.
    static PlantRegion of_ranges(const Plant& plant);

    /// The joint 95 % confidence ellipsoid (theta - theta0)' V^-1 (theta - theta0) <= chi^2_p(0.95) of p = names.size()
    /// <= 8 parameters: a ball, z along the principal axes of the correlation matrix (Draper and Smith 1998, section
    /// 5.4). L is cut off at 0. A direction that would reverse the sign of a time constant (or of a1, a2) ends where
    /// that has fallen to a twentieth. Error: numerical_failure for a matrix that is no covariance of these names.
    static Expected<PlantRegion> of_covariance(const Plant& plant, const std::vector<std::string>& names,
                                               const std::vector<std::vector<double>>& covariance);

    int dimension() const { return static_cast<int>(axes_.size()); }
    const Plant& nominal() const { return plant_; }

    Plant at(const Point& z) const;   ///< z of `dimension()` numbers inside the region
    Point inside(Point z) const;      ///< the nearest point of cube or ball
    std::vector<Point> ends() const;  ///< corners and centre of the cube; ends of axes and of diagonals of the ball
    std::vector<Point> spread(int count) const;  ///< uniform in cube or ball: a Halton sequence, the same every time;
                                                 ///< one point at dimension 0

private:
    Plant plant_;
    bool ball_ = false;
    std::vector<std::string> names_;
    std::vector<double> centre_;
    std::vector<std::vector<double>> axes_;  ///< column k: what z_k moves
};

/// A parameter of a plant by its name, as PlantRegion names them; 0 for a name that the type does not have.
double parameter(const Plant& plant, const std::string& name);
void set_parameter(Plant& plant, const std::string& name, double value);

}  // namespace tunewright
