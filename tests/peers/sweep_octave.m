% The sweep of Figure 10 by Octave, as a user would write it: lumped in closed form, coverage by fzero.
% Prints model,microseconds_per_point,coverage,strain for some points of the sweep.
1;
function s = stress(l)
  j = 2*l^2 + l^-4 - 3;
  s = 2*(l^2 - l^-4)*(178426 + 2*-6023*j + 3*4234*j^2);
end
function y = modulus(l)
  j = 2*l^2 + l^-4 - 3;
  w = 178426 + 2*-6023*j + 3*4234*j^2;
  y = 2*(2*l + 4*l^-5)*w + 2*(l^2 - l^-4)*(2*-6023 + 6*4234*j)*4*(l - l^-5);
end
function s = lumped(b, m, pre)
  s = (1 - b)*m*pre^4/modulus(pre);
end
function s = coverage(b, m, pre)
  imbalance = @(s) stress(pre*(1 + s)) - m*(pre*(1 + s))^4 - stress(pre*(1 - b*(1 + s))/(1 - b));
  s = fzero(imbalance, [0, 0.2*min(1, (1 - b)/b)], optimset('TolX', 1e-15));
end
function sweep(name, model, points, m, pre)
  grid = linspace(0.1, 0.9, points);
  strains = zeros(1, points);
  tic;
  for i = 1:points
    strains(i) = model(grid(i), m, pre);
  end
  microseconds = 1e6*toc/points;
  for i = 1:(points - 1)/4:points
    printf("%s,%.6g,%.17g,%.17g\n", name, microseconds, grid(i), strains(i));
  end
end
m = 8.8541878128e-12*2.8*(4500/100e-6)^2;
sweep("lumped", @lumped, 401, m, 1.2);
sweep("coverage", @coverage, 101, m, 1.2);

