# mypy: ignore-errors
# Relay test, written by Tunewright 1.0.0.
#
# Sample time   1 s, as asked for
# Settings      Ts 1, u_step 1, rate_limit 0, quiet_time 30, max_time 5000, hysteresis_min 0,
#               frozen_time 0, longest_gap 5, u_tolerance 0.1, asymmetry 0.3, cycles 0, sign 0
#
# Relay test: u moves between u0 + u_step (1 + asymmetry) and u0 - u_step (1 - asymmetry), each
# within u_min and u_max, whenever y has left a band about y0; u0 and y0 are u and y before the
# test. The band's half width, the hysteresis, is three standard deviations of the noise, and more
# than the sensor's resolution.
#
# It ends when period and amplitude have changed by less than 2 % (and by no more than noise and
# sample time explain) in two cycles in a row, with noise in more; or after the cycles that are
# asked for, at most 30.
#
# sign: that of the plant's gain. 1: y rises with u, the loop's controller is reverse acting; -1:
# direct acting; 0: found from the first move. Give it for a plant that is unstable or that first
# moves the wrong way.
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
#     relay = TunewrightRelay()
# and then every Ts seconds:
#     u, mode, reason, recording = relay.step(measurement, u_controller, start, measurement_ok=True, now=-1.0, u_actual=1.0e30)
# Settings are attributes: relay.u_max = 2.0


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


class TunewrightRelay:
    """A sampled relay test."""

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
        self.asymmetry = 0.3  # levels: u0 + u_step (1 + asymmetry) and u0 - u_step (1 - asymmetry)
        self.cycles = 0.0  # exactly so many; 0: until the cycle is steady
        self.sign = 0.0  # of the plant's gain, 1 or -1; 0: found from the first move

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
        self.sign_found = 0.0  # the sign in use; 0: not yet known
        self.turned = False  # true: the found sign was wrong and has been turned
        self.up = False  # true: u is at its upper level
        self.u_up = 0.0  # upper level
        self.u_down = 0.0  # lower level
        self.y_high = 0.0  # largest y - y0 of this cycle
        self.y_low = 0.0  # least y - y0 of this cycle
        self.cycles_done = 0.0  # complete cycles
        self.period = 0.0  # of the last cycle, in s
        self.amplitude = 0.0  # half the range of y in the last cycle
        self.steady = 0.0  # cycles in a row that were like the one before
        self.t_cycle = 0.0  # time at which this cycle began; 0: none yet
        self.beyond = 0.0  # calls in a row with y outside the band, until the sign is known
        self.longest_half = 0.0  # longest time between two moves of u

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
                self.sign_found = self.sign
                self.turned = False
                self.up = True
                self.u_up = self.u0 + self.u_step * (1.0 + self.asymmetry)
                self.u_down = self.u0 - self.u_step * (1.0 - self.asymmetry)
                if self.u_up > self.u_max:
                    self.u_up = self.u_max
                if self.u_up < self.u_min:
                    self.u_up = self.u_min
                if self.u_down > self.u_max:
                    self.u_down = self.u_max
                if self.u_down < self.u_min:
                    self.u_down = self.u_min
                self.y_high = 0.0
                self.y_low = 0.0
                self.cycles_done = 0.0
                self.period = 0.0
                self.amplitude = 0.0
                self.steady = 0.0
                self.t_cycle = 0.0
                self.beyond = 0.0
                self.longest_half = 0.0
                if (not ((self.u0 >= self.u_min) and (not (self.u0 > self.u_max)))) or ((not (self.u_up - self.u0 > 0.1 * self.u_step)) or (not (self.u0 - self.u_down > 0.1 * self.u_step))):
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
                self.target = self.u_up

        # The test.
        if (not (self.mode_now != 2)) or (not (self.mode_now != 3)):
            deviation = measurement - self.y0
            half = self.t - self.t_phase
            if self.sign_found != 0.0:
                error = self.sign_found * deviation
                if deviation > self.y_high:
                    self.y_high = deviation
                if deviation < self.y_low:
                    self.y_low = deviation
                if (self.up and (error > self.hysteresis)) or ((not self.up) and (error < (-self.hysteresis))):
                    if half > self.longest_half:
                        self.longest_half = half
                    self.t_phase = self.t
                    self.mode_now = 3
                    self.up = not self.up
                    self.target = self.u_down
                    if self.up:
                        self.target = self.u_up
                        if self.t_cycle > 0.0:
                            period_now = self.t - self.t_cycle
                            amplitude_now = (self.y_high - self.y_low) / 2.0
                            period_change = period_now - self.period
                            if period_change < 0.0:
                                period_change = -period_change
                            amplitude_change = amplitude_now - self.amplitude
                            if amplitude_change < 0.0:
                                amplitude_change = -amplitude_change
                            if (not (period_change * amplitude_now > (0.02 * period_now + 2.0 * self.Ts) * amplitude_now + self.hysteresis / 3.0 * period_now / 2.0)) and (not (amplitude_change * period_now > (0.02 * period_now + 2.0 * self.Ts) * amplitude_now + self.hysteresis / 3.0 * period_now)):
                                self.steady = self.steady + 1.0
                            else:
                                self.steady = 0.0
                            self.period = period_now
                            self.amplitude = amplitude_now
                            self.cycles_done = self.cycles_done + 1.0
                            if self.cycles > 0.0:
                                if self.cycles_done >= self.cycles:
                                    self.mode_now = 4
                                    self.reason_now = 2
                                    self.target = self.u0
                            else:
                                if self.steady * self.amplitude >= 2.0 * self.amplitude + 100.0 * self.noise:
                                    self.mode_now = 4
                                    self.reason_now = 1
                                    self.target = self.u0
                                else:
                                    if self.cycles_done >= 30.0:
                                        self.mode_now = 4
                                        self.reason_now = 2
                                        self.target = self.u0
                        self.t_cycle = self.t
                        self.y_high = deviation
                        self.y_low = deviation
                else:
                    if (self.sign == 0.0) and ((not self.turned) and (self.cycles_done < 3.0)) and (((self.up and (error < (-self.hysteresis))) or ((not self.up) and (error > self.hysteresis))) and (half > 5.0 * self.longest_half + 20.0 * self.Ts)):
                        self.sign_found = -self.sign_found
                        self.turned = True
                    else:
                        if (not (self.mode_now != 3)) and (half > 10.0 * self.longest_half + 20.0 * self.Ts):
                            self.mode_now = 5
                            self.reason_now = 17
            else:
                size = deviation
                if size < 0.0:
                    size = -size
                if size > self.hysteresis:
                    self.beyond = self.beyond + 1.0
                else:
                    self.beyond = 0.0
                if self.beyond > 4.0:
                    self.longest_half = half
                    self.sign_found = 1.0
                    if deviation < 0.0:
                        self.sign_found = -1.0
            if (not (self.mode_now != 2)) and (half > self.max_time / 2.0):
                self.mode_now = 5
                self.reason_now = 17

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
