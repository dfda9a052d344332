% The switch-on/off protocol of 25 s (lumped, mass, three branches, 2501 samples) by Octave's ode15s, which is IDA, as a user would
% write it: restarted at every edge, with the Jacobian. Usage: octave-cli transient_octave.m RTOL [RTOL ...]
% Prints method,rtol,milliseconds,error: time of the solve alone (median of three where it is short), error relative to the peak against matrix exponentials.
1;
function [a, b, k] = network()
  r = 0.03; cover = 0.5; h = 1e-4; pre = 1.2; rho = 1080;
  g = [0.1, 0.1, 0.05]; tau = [0.001, 0.3, 3];
  j = 2*pre^2 + pre^-4 - 3;
  w = 178426 + 2*-6023*j + 3*4234*j^2;
  y = 2*(2*pre + 4*pre^-5)*w + 2*(pre^2 - pre^-4)*(2*-6023 + 6*4234*j)*4*(pre - pre^-5);
  ra = cover*r;
  cross = 2*pi*ra*h/pre^2;
  k = y*cross*(1/ra + 1/(r - ra));
  force = 8.8541878128e-12*2.8*pre^4/h^2*cross;
  A = ra/pre; F = r/pre;
  m = pi*rho*h*A^2/2 + 2*pi*rho*h*A^2/(F^2 - A^2)^2*(F^4*log(F/A) - F^2*(F^2 - A^2) + (F^4 - A^4)/4);
  a = zeros(5);
  a(1, 2) = 1;
  a(2, :) = [-k, 0, -1, -1, -1]/m;
  for i = 1:3
    a(2 + i, 2) = g(i)/(1 - sum(g))*k;
    a(2 + i, 2 + i) = -1/tau(i);
  end
  b = [0; force/m; 0; 0; 0];
end
function [transfer, push] = flow(a, b, duration, u0, rate)
  % exp of the network with f = U^2, f' = g, g' = 2 h driving it
  big = [a, b, zeros(5, 2); zeros(3, 8)];
  big(6, 7) = 1;
  big(7, 8) = 2;
  whole = expm(big*duration);
  transfer = whole(1:5, 1:5);
  push = whole(1:5, 6:8)*[u0^2; 2*u0*rate; rate^2];
end
function u = exact(a, b)
  rise = 1e-6; every = 0.01; volts = 4500;
  [free, ~] = flow(a, b, every, 0, 0);
  [hold, pushed] = flow(a, b, every, volts, 0);
  [up, up_push] = flow(a, b, rise, 0, volts/rise);
  [on, on_push] = flow(a, b, every - rise, volts, 0);
  [down, down_push] = flow(a, b, rise, volts, -volts/rise);
  [off, ~] = flow(a, b, every - rise, 0, 0);
  x = zeros(5, 1);
  u = zeros(2501, 1);
  for i = 1:2500
    if i == 501
      x = on*(up*x + up_push) + on_push;
    elseif i == 1501
      x = off*(down*x + down_push);
    elseif i > 501 && i < 1501
      x = hold*x + pushed;
    else
      x = free*x;
    end
    u(i + 1) = x(1);
  end
end
function u = solve(a, b, k, peak, rtol)
  grid = (0:2500)'*0.01;
  corners = [0, 5, 5.000001, 15, 15.000001, 25];
  levels = [0, 0, 4500, 4500, 0, 0];
  scale = peak*[1; 4000; k*[0.1; 0.1; 0.05]];
  x = zeros(5, 1);
  u = zeros(2501, 1);
  for s = 1:5
    rate = (levels(s + 1) - levels(s))/(corners(s + 1) - corners(s));
    slope = @(t, y) a*y + b*(levels(s) + rate*(t - corners(s)))^2;
    inside = find(grid > corners(s) & grid <= corners(s + 1));
    % ode15s gives up after 500 steps without an output, and takes two times as "wherever you step"
    wanted = unique([corners(s); grid(inside); corners(s + 1)]);
    between = max(2, round(2*(1e-4/rtol)^0.3));
    times = interp1(1:numel(wanted), wanted, linspace(1, numel(wanted), (numel(wanted) - 1)*between + 1))';
    times(1:between:end) = wanted;
    options = odeset('RelTol', rtol, 'AbsTol', rtol*scale, 'Jacobian', a);
    [~, y] = ode15s(slope, times, x, options);
    u(inside) = y(1 + between*(1:numel(inside)), 1);
    x = y(end, :)';
  end
end
[a, b, k] = network();
reference = exact(a, b);
peak = max(abs(reference));
tolerances = argv();
for i = 1:numel(tolerances)
  rtol = str2double(tolerances{i});
  spent = [];
  while numel(spent) < 3 && sum(spent) < 3 % what takes seconds is timed once
    begin = tic;
    u = solve(a, b, k, peak, rtol);
    spent(end + 1) = toc(begin);
  end
  printf("ode15s,%g,%.6g,%.3g\n", rtol, 1e3*median(spent), max(abs(u - reference))/peak);
end
