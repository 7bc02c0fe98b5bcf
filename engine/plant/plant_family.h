// Every plant that one controller must serve: a nominal one, perhaps others, and around each a continuous region of
// plants given by ranges or a covariance of its parameters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The plants whose parameters are centre + A z, z in the cube |z_i| <= 1 or in the ball |z| <= 1. Parameters have
/// names: K, T, T1, T2, zeta, L, and a1, a2, a3, b of a `TransferFunction` (K b s + K)/(a3 s^3 + a2 s^2 + a1 s + 1),
/// perhaps over s. K of a transfer function is its numerator's last coefficient other than 0, which scales all of them;
/// of a state space a factor of C and D.
class PlantRegion {
public:
    using Point = std::vector<double>;

    /// The plant's own `uncertainty`: a cube; of dimension 0 if it has none.
    static PlantRegion of_ranges(const Plant& plant);

    /// The joint 95 % confidence ellipsoid (theta - theta0)' V^-1 (theta - theta0) <= chi^2_p(0.95) of p = names.size()
    /// <= 8 parameters: a ball, z along the principal axes of the correlation matrix (Draper and Smith 1998, section
    /// 5.4). L is limited to 0. A direction that would change the sign of a time constant (or of a1, a2) ends where it
    /// has fallen to a twentieth. Errors: invalid_argument for the names, numerical_failure for the matrix.
    static Expected<PlantRegion> of_covariance(const Plant& plant, const std::vector<std::string>& names,
                                               const std::vector<std::vector<double>>& covariance);

    /// Moves each of ends() to this share (0 to 1, one for each) of its distance from the centre; directions between
    /// them by inverse distance (Shepard 1968). For knowledge of the plants in addition to the covariance.
    void cut(std::vector<double> shares);

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
    std::vector<std::vector<double>> axes_;  ///< column k: the change of the parameters with z_k
    std::vector<Point> cut_ends_;            ///< of length 1; empty: the region is not cut
    std::vector<double> shares_;             ///< shares of these ends

    double share_towards(const Point& z) const;
};

/// A parameter of a plant by its name in PlantRegion; 0 for a name that the type does not have.
double parameter(const Plant& plant, const std::string& name);
void set_parameter(Plant& plant, const std::string& name, double value);

/// One region for each plant, of dimension 0 if it has no uncertainty; the first one surrounds the nominal plant.
struct PlantFamily {
    std::vector<PlantRegion> regions;

    const Plant& nominal() const { return regions.front().nominal(); }
    bool single() const { return regions.size() == 1 && regions.front().dimension() == 0; }
};

/// Figures of one controller over all plants of a family.
struct RegionFigures {
    double stable_fraction = 0;  ///< fraction of the family, 0 to 1
    Figure worst_Ms;             ///< empty if not every evaluated plant is stable
    Plant worst_plant;           ///< the plant with the largest Ms, or an unstable one
};

PlantFamily family_of(const Plant& plant);
PlantFamily family_of(const PlantSet& set);

/// The plants at the ends of every region, without the nominal plant.
std::vector<Plant> members_without_nominal(const PlantFamily& family);

}  // namespace tunewright
