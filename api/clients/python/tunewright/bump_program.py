# mypy: ignore-errors
# Step test, written by Tunewright 1.0.0.
#
# Sample time   1 s, as asked for
# Settings      Ts 1, u_step 1, rate_limit 0, quiet_time 30, max_time 5000, hysteresis_min 0,
#               frozen_time 0, longest_gap 5, u_tolerance 0.1, y_move 0
#
# Step test: u moves by u_step, within u_min and u_max, until y has settled, and back for as long.
# y has settled when two means in a row, each over the last fifth of the time since the step,
# differ by less than 2 % of the whole change and no more than the noise explains. y_move ends the
# step earlier: needed for a plant that integrates; a plant that is unstable needs the relay test.
#
# Wiring: u_controller is the output of the loop's controller, u goes to the actuator. While mode
# is not 0, keep the controller in manual with u as its manual output; it then takes over without
# a jump.
#
# start: when it rises, u is held for quiet_time, in which the noise of y and its level y0 are
# measured; then the test begins. It ends by itself with u as before the test. When start falls, a
# running test ends at once in the same way. Each call with recording true gives one row t, u, y
# of the record.
#
# Faults: a bad measurement (measurement_ok false, or not a number), one that stays the same for
# too long, y beyond y_min or y_max, an actuator that reads back another u, a clock that jumps, a
# start that is true in the first call, as after a loss of power, no response, max_time. From that
# call on u is u_safe, or u as before the test, until start falls. reason says which fault it was.
#
# Values of reason:
#   0 no test has ended since the start
#   1 complete: the response is steady
#   2 complete: the number of cycles is reached
#   3 ended by the operator
#   10 the measurement is bad: check the sensor and its connection
#   11 the measurement does not change any more: check the sensor
#   12 y fell below y_min: take a smaller u_step, or a lower limit
#   13 y rose above y_max: take a smaller u_step, or a higher limit
#   14 the actuator reads back another u: is it in automatic, and within its range?
#   15 the clock jumped, or a call came too late: call every Ts seconds
#   16 start was true in the first call, as after a loss of power: set start to false, then to
#      true
#   17 y did not answer in time: take a larger u_step, check the actuator and the sign
#   18 the longest time is over: take a longer max_time
#   19 the test cannot begin: u before the test is too near to a limit of u, or beyond it
#
# Call, for each controller:
#     bump = TunewrightBump()
# and then every Ts seconds:
#     u, mode, reason, recording = bump.step(measurement, u_controller, start, measurement_ok=True, now=-1.0, u_actual=1.0e30)
# Settings are attributes: bump.u_max = 2.0


REASONS = {
    0: "no test has ended since the start",
    1: "complete: the response is steady",
    2: "complete: the number of cycles is reached",
    3: "ended by the operator",
    10: "the measurement is bad: check the sensor and its connection",
    11: "the measurement does not change any more: check the sensor",
    12: "y fell below y_min: take a smaller u_step, or a lower limit",
    13: "y rose above y_max: take a smaller u_step, or a higher limit",
    14: "the actuator reads back another u: is it in automatic, and within its range?",
    15: "the clock jumped, or a call came too late: call every Ts seconds",
    16: "start was true in the first call, as after a loss of power: set start to false, then to true",
    17: "y did not answer in time: take a larger u_step, check the actuator and the sign",
    18: "the longest time is over: take a longer max_time",
    19: "the test cannot begin: u before the test is too near to a limit of u, or beyond it",
}


class TunewrightBump:
    """A sampled step test."""

    def __init__(self):
        self.Ts = 1.0  # sample time in s: the time from call to call
        self.u_step = 1.0  # size of the moves of u
        self.u_min = -1.0e30  # least u
        self.u_max = 1.0e30  # largest u
        self.y_min = -1.0e30  # y below it stops the test
        self.y_max = 1.0e30  # y above it stops the test
        self.u_safe = 1.0e30  # u after a fault; 1e30: as before the test
        self.rate_limit = 0.0  # largest change of u per second, faults excepted; 0: no limit
        self.quiet_time = 30.0  # time in s in which u is held and the noise measured
        self.max_time = 5000.0  # longest test in s
        self.hysteresis_min = 0.0  # least hysteresis, in y; more if the noise demands it
        self.frozen_time = 0.0  # y unchanged for longer, in s, is a fault; 0: by itself
        self.longest_gap = 5.0  # longest time in s between two calls by the clock
        self.u_tolerance = 0.1  # largest difference of u_actual from u
        self.y_move = 0.0  # the step ends when y has moved so far; 0: when y has settled

        # Memory; do not write to it.
        self.powered = False  # false before the first call
        self.start_last = False  # start of the last call
        self.mode_now = 0  # mode of the last call
        self.reason_now = 0  # reason of the last end
        self.timed = False  # true: a clock was given at the start
        self.now_last = 0.0  # clock of the last call
        self.t = 0.0  # time since the start in s
        self.t_phase = 0.0  # time of the last move of u
        self.u0 = 0.0  # u before the test
        self.u_last = 0.0  # u of the last call
        self.target = 0.0  # where u goes
        self.y0 = 0.0  # mean of y in the quiet time
        self.y_last = 0.0  # y of the last call
        self.noise = 0.0  # standard deviation of the noise of y
        self.hysteresis = 0.0  # y must leave this band about y0, to either side
        self.calls = 0.0  # calls of the quiet time
        self.sum = 0.0  # sum of y - y_first in the quiet time
        self.highest = 0.0  # largest y - y_first in the quiet time
        self.lowest = 0.0  # the least
        self.largest = 0.0  # largest change of y in the quiet time
        self.second = 0.0  # the second largest
        self.changes = 0.0  # sum of the sizes of the changes of y
        self.least_change = 0.0  # the smallest of them that is not 0
        self.unchanged = 0.0  # calls in which y did not change
        self.run = 0.0  # calls in a row without a change
        self.longest_run = 0.0  # the longest such run in the quiet time
        self.level = 0.0  # u of the step
        self.window_end = 0.0  # time since the move at which this window ends
        self.window_sum = 0.0  # sum of y - y0 in it
        self.window_calls = 0.0  # calls in it
        self.windows = 0.0  # complete windows since the move
        self.mean = 0.0  # mean of y - y0 in the last window
        self.steady = 0.0  # windows in a row that were like the one before
        self.moved = False  # true: y has left the band
        self.up_time = 0.0  # how long u was at its level, in s

    def step(self, measurement, u_controller, start, measurement_ok=True, now=-1.0, u_actual=1.0e30):
        """One call every Ts seconds; the answer is u, mode, reason, recording."""
        # A u_controller that is not a number: the last u in its place.
        u_given = u_controller
        if u_given != u_given:
            u_given = self.u_last

        # The start.
        if start and (not self.powered):
            self.mode_now = 5
            self.reason_now = 16
            self.u0 = u_given
        else:
            if start and ((not self.start_last) and (not (self.mode_now != 0))):
                self.mode_now = 1
                self.reason_now = 0
                self.u0 = u_given
                self.target = u_given
                self.u_last = u_given
                self.timed = now >= 0.0
                self.now_last = now - self.Ts
                self.y_last = measurement
                self.y0 = measurement
                self.t = -self.Ts
                self.t_phase = 0.0
                self.noise = 0.0
                self.hysteresis = 0.0
                self.calls = 0.0
                self.sum = 0.0
                self.highest = 0.0
                self.lowest = 0.0
                self.changes = 0.0
                self.largest = 0.0
                self.second = 0.0
                self.least_change = 0.0
                self.unchanged = 0.0
                self.run = 0.0
                self.longest_run = 0.0
                self.level = self.u0 + self.u_step
                self.moved = False
                if self.level > self.u_max:
                    self.level = self.u_max
                if self.level < self.u_min:
                    self.level = self.u_min
                self.window_end = 0.0
                self.window_sum = 0.0
                self.window_calls = 0.0
                self.windows = 0.0
                self.mean = 0.0
                self.steady = 0.0
                self.up_time = 0.0
                if (not ((self.u0 >= self.u_min) and (not (self.u0 > self.u_max)))) or (not ((self.level - self.u0) / self.u_step > 0.1)):
                    self.mode_now = 5
                    self.reason_now = 19
        self.powered = True
        self.start_last = start

        # The end by the operator: u goes back first, then the controller has it.
        u = u_given
        recording = False
        if not start:
            if (not (self.mode_now != 1)) or ((not (self.mode_now != 2)) or (not (self.mode_now != 3))):
                self.mode_now = 4
                self.reason_now = 3
                self.target = self.u0
            else:
                if (self.mode_now != 0) and (not ((not (self.mode_now != 4)) and (self.u_last != self.target))):
                    u = self.u_last
                    self.mode_now = 0
        if not (self.mode_now != 0):
            self.u_last = u
        running = (not (self.mode_now != 1)) or ((not (self.mode_now != 2)) or (not (self.mode_now != 3)))

        # The faults, the gravest first. A value that is not a number equals nothing, itself included.
        elapsed_now = self.Ts
        if self.timed:
            elapsed_now = now - self.now_last
        difference = u_actual - self.u_last
        if difference < 0.0:
            difference = -difference
        watched = running or (not (self.mode_now != 4))
        if watched and ((not measurement_ok) or (measurement != measurement)):
            self.mode_now = 5
            self.reason_now = 10
            running = False
            watched = False
        if running and (not ((elapsed_now > 0.0) and (not (elapsed_now > self.longest_gap)))):
            self.mode_now = 5
            self.reason_now = 15
            running = False
            watched = False
        if running and ((self.t >= 0.0) and ((u_actual != u_actual) or ((u_actual < 1.0e30) and (difference > self.u_tolerance)))):
            self.mode_now = 5
            self.reason_now = 14
            running = False
            watched = False
        if watched and (measurement < self.y_min):
            self.mode_now = 5
            self.reason_now = 12
            running = False
            watched = False
        if watched and (measurement > self.y_max):
            self.mode_now = 5
            self.reason_now = 13
            running = False
            watched = False
        if running:
            self.t = self.t + elapsed_now
            if not (self.calls > 0.0):
                self.t = 0.0
        self.now_last = now
        change = measurement - self.y_last
        if change < 0.0:
            change = -change
        if change > 0.0:
            self.run = 0.0
        else:
            self.run = self.run + 1.0
        if running and (((self.frozen_time > 0.0) and (self.run * self.Ts > self.frozen_time)) or ((not (self.frozen_time > 0.0)) and (not (not (self.mode_now != 1))) and ((self.changes > 0.0) and (self.run > 5.0 * self.longest_run + 20.0)))):
            self.mode_now = 5
            self.reason_now = 11
            running = False
            watched = False
        if running and (self.t > self.max_time):
            self.mode_now = 5
            self.reason_now = 18
            running = False
            watched = False

        # The quiet time: the noise of y, from its changes from call to call.
        if running and (not (self.mode_now != 1)):
            self.calls = self.calls + 1.0
            self.sum = self.sum + (measurement - self.y0)
            if measurement - self.y0 > self.highest:
                self.highest = measurement - self.y0
            if measurement - self.y0 < self.lowest:
                self.lowest = measurement - self.y0
            if change > self.largest:
                self.second = self.largest
                self.largest = change
            else:
                if change > self.second:
                    self.second = change
            if self.calls > 1.0:
                self.changes = self.changes + change
                if change > 0.0:
                    if (not (self.least_change > 0.0)) or (change < self.least_change):
                        self.least_change = change
                else:
                    self.unchanged = self.unchanged + 1.0
                if self.run > self.longest_run:
                    self.longest_run = self.run
            if (self.t >= self.quiet_time) and (self.calls > 9.0):
                self.noise = 0.8862269254527579 * (self.changes - self.largest - self.second) / (self.calls - 3.0)
                if self.largest > 8.0 * self.noise:
                    self.y0 = self.y0 + (self.sum - self.highest - self.lowest) / (self.calls - 2.0)
                else:
                    self.noise = 0.8862269254527579 * self.changes / (self.calls - 1.0)
                    self.y0 = self.y0 + self.sum / self.calls
                self.hysteresis = 3.0 * self.noise
                if (5.0 * self.unchanged > self.calls) and (1.5 * self.least_change > self.hysteresis):
                    self.hysteresis = 1.5 * self.least_change
                if self.hysteresis_min > self.hysteresis:
                    self.hysteresis = self.hysteresis_min
                self.t_phase = self.t
                self.mode_now = 2
                self.target = self.level
                self.window_end = 10.0 * self.Ts

        # The test.
        if (not (self.mode_now != 2)) or (not (self.mode_now != 3)):
            deviation = measurement - self.y0
            elapsed = self.t - self.t_phase
            self.window_sum = self.window_sum + deviation
            self.window_calls = self.window_calls + 1.0
            size = deviation
            if size < 0.0:
                size = -size
            if size > 2.0 * self.hysteresis:
                self.moved = True
            if not (self.mode_now != 2):
                if (self.y_move > 0.0) and (size >= self.y_move):
                    self.mode_now = 3
                    self.up_time = elapsed
                    self.t_phase = self.t
                    self.target = self.u0
                else:
                    if elapsed > self.max_time / 2.0:
                        if self.moved:
                            self.mode_now = 3
                            self.up_time = elapsed
                            self.t_phase = self.t
                            self.target = self.u0
                        else:
                            self.mode_now = 5
                            self.reason_now = 17
            else:
                if elapsed > self.up_time:
                    self.mode_now = 4
                    self.reason_now = 1
                    self.target = self.u0
            if (not (self.mode_now != 2)) and (elapsed >= self.window_end):
                mean_now = self.window_sum / self.window_calls
                mean_change = mean_now - self.mean
                if mean_change < 0.0:
                    mean_change = -mean_change
                if (self.windows > 0.0) and self.moved:
                    size = mean_now
                    if size < 0.0:
                        size = -size
                    if mean_change > 0.02 * size + self.noise / 2.0:
                        self.steady = 0.0
                    else:
                        self.steady = self.steady + 1.0
                if self.steady >= 2.0:
                    self.mode_now = 3
                    self.up_time = elapsed
                    self.t_phase = self.t
                    self.target = self.u0
                self.mean = mean_now
                self.windows = self.windows + 1.0
                self.window_sum = 0.0
                self.window_calls = 0.0
                self.window_end = 1.25 * self.window_end + self.Ts

        # u: towards its target within its rate; after a fault the safe value at once.
        if not ((not (self.mode_now != 0)) or (not (self.mode_now != 5))):
            low = self.u_min
            high = self.u_max
            if self.rate_limit > 0.0:
                low = self.u_last - self.rate_limit * elapsed_now
                high = self.u_last + self.rate_limit * elapsed_now
            u = self.target
            if u > high:
                u = high
            if u < low:
                u = low
            if u > self.u_max:
                u = self.u_max
            if u < self.u_min:
                u = self.u_min
        if not (self.mode_now != 5):
            u = self.u0
            if self.u_safe < 1.0e30:
                u = self.u_safe

        # For the next call, and the row of the record.
        recording = running
        self.u_last = u
        self.y_last = measurement
        mode = self.mode_now
        reason = self.reason_now
        return u, mode, reason, recording

    def row(self):
        """A row of the record, t,u,y, without a line end."""
        return "%.10g,%.10g,%.10g" % (self.t, self.u_last, self.y_last)
