% The design with the functions of Octave's package control, in the way of its example optiPID: fminsearch over Kp, Ti
% and Td from a rule of Åström and Hägglund on the ultimate point. With one word:
%
%   optipid   the example's own objective: ITAE + 10 times the overshoot (both of a set-point step) + 20 Ms. It knows no
%             limits, and its answers are judged by them all the same.
%   limits    the load IAE with a penalty for Ms and Mt beyond 1.4, over the logarithms, from its own end once more
%
% Of ours are the measurement filter, the approximation of the dead time, and the unit of time, in which the ultimate
% period is that of the example's plant.
% Reads plants (num, den, dead time between tabs behind a name), writes name, Kp, Ti, Td, ms.
1;

function C = controller (x)
  Tf = 0.1 * x(3);
  C = tf (x(1) * [x(2)*x(3), x(2), 1], conv ([x(2), 0], [Tf^2/2, Tf, 1]));
end

% By Pade, of order 3.
function D = dead_time (L)
  D = tf ([-L^3, 12*L^2, -60*L, 120], [L^3, 12*L^2, 60*L, 120]);
end

function J = optipid (x, P)
  J = 1e6;
  if (any (x <= 0))
    return;
  end
  L = P * controller (x);
  T = feedback (L, 1);
  if (! isstable (T))
    return;
  end
  t = 0 : 0.05 : 30;
  y = step (T, t);
  itae = sum (t(:) .* abs (1 - y(:))) * t(2);
  J = itae + 10 * (max (y) - 1) + 20 * norm (feedback (1, L), inf);
end

function J = penalised (x, P)
  C = controller (exp (x));
  L = P * C;
  T = feedback (L, 1);
  if (! isstable (T))
    J = 1e6;
    return;
  end
  t = 0 : 0.1 : 120;
  iae = trapz (t(:), abs (step (feedback (P, C), t))(:));
  beyond = max (norm (feedback (1, L), inf, 1e-4), norm (T, inf, 1e-4)) / 1.4 - 1;
  J = log (iae) + 20 * max (beyond, 0);
end

% The first frequency at which the phase passes -180 degrees.
function w = phase_crossover (num, den, L)
  w = logspace (-5, 5, 20000);
  phase = unwrap (arg (polyval (num, 1i*w) ./ polyval (den, 1i*w))) - w*L;
  w = w(find (phase < -pi, 1));
end

function x = astrom_hagglund (P, num, den)
  [ku, phase, w] = margin (P);
  kappa = 0;
  if (den(end) != 0)
    kappa = den(end) / num(end) / ku;
  end
  Tu = 2*pi / w;
  x = [ku * 0.72 * exp(-1.6*kappa + 1.2*kappa^2), Tu * 0.59 * exp(-1.3*kappa + 0.38*kappa^2), ...
       Tu * 0.15 * exp(-1.4*kappa + 0.56*kappa^2)];
end

function x = design (word, num, den, L)
  example = 9.7;  % the ultimate period of its plant, which is looked at for 30
  unit = 2*pi / phase_crossover (num, den, L) / example;
  powers = @(p) unit .^ -(numel (p) - 1 : -1 : 0);
  num = num .* powers (num);
  den = den .* powers (den);
  P = tf (num / den(1), den / den(1));
  if (L > 0)
    P = P * dead_time (L / unit);
  end
  x = astrom_hagglund (P, num, den);
  if (strcmp (word, "optipid"))
    x = fminsearch (@(x) optipid (x, P), x);
  else
    x = log (x .* [0.4, 1, 1]);  % the rule is for Ms = 2
    for attempt = 1 : 2
      x = fminsearch (@(x) penalised (x, P), x, optimset ("TolX", 1e-4, "TolFun", 1e-5));
    end
    x = exp (x);
  end
  x(2:3) *= unit;
end

if (any (strcmp (argv (), "--version")))
  printf ("%s, Octave %s\n", pkg ("list", "control"){1}.version, version ());
  return;
end
pkg load control
warning ("off");
word = argv (){end};
while (ischar (line = fgetl (stdin)))
  fields = strsplit (line, "\t");
  began = cputime ();
  try
    x = design (word, str2num (fields{2}), str2num (fields{3}), str2double (fields{4}));
    printf ("%s\t%.12g\t%.12g\t%.12g\t%.6g\n", fields{1}, x, 1e3 * (cputime () - began));
    fflush (stdout);
  catch fault
    fprintf (stderr, "%s: %s\n", fields{1}, fault.message);
  end
end
