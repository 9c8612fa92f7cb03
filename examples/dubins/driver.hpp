// The feedback controller: drives a tour of waypoints, inside the world and outside forbidden
// areas. Takes: the car's state at each step. Gives: the turn rate that leads to the next waypoint
// in the shortest time. Keeps true: without disturbance the car never leaves the world, not even
// after its last waypoint.
#pragma once

#include <cstddef>
#include <vector>

#include "time_field.hpp"

namespace demo {

struct Tour {
    std::vector<Point> waypoints;
    std::vector<Disc> forbidden;
    double reach = 0.15;  ///< a waypoint counts as visited within this distance, m
};

/// A tour with the time fields that lead along it. Solving them takes a while; one route serves any
/// number of drives.
class Route {
public:
    explicit Route(Tour tour);

    const Tour& tour() const { return tour_; }
    /// The time to a waypoint, by its index; after the last, the time to where the car can circle
    /// for ever.
    const TimeField& leg(std::size_t index) const { return legs_[index]; }
    /// Returns whether a drive may start there: some path from it never ends.
    bool can_start(const Car& car) const { return legs_.back().reachable(car); }

private:
    Tour tour_;
    std::vector<TimeField> legs_;
};

class Driver {
public:
    explicit Driver(const Route& route) : route_(route) {}

    /// Returns the turn rate for the next step; after the last waypoint the car circles.
    double turn_rate(const Car& car);

private:
    const Route& route_;
    std::size_t next_ = 0;  ///< index of the next waypoint
};

}  // namespace demo
