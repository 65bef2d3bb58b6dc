function dy = derivative(v, y, command)
% DERIVATIVE  Return the derivative of the state in the mathematical model of chapter 2, eq. (2.38).
%
%   [t, y] = ode45(@(t, y) quadcore.derivative(v, y, command), [0 5], y0)
%
% v: vehicle, from `quadcore info MODEL --vehicle v.mat`. y: position of the centre of mass (m), roll,
% pitch, yaw (rad), the rates of these six, and rotor speeds (rad/s) before the division by sim_slow.
% command: desired rotor speeds (rad/s); the motors follow with a lag. For the equations, see
% docs/physics.md.
  q = y(1:6); qdot = y(7:12); omega = y(13:end);
  omegadot = (v.motor_gain * (command(:) - omega) - v.joint_damping(:) .* omega) ...
             ./ v.rotor_inertia(:);
  dy = [qdot; acceleration(v, q, qdot, omega); omegadot];
end

function qddot = acceleration(v, q, qdot, omega)
  eta = q(4:6); etadot = qdot(4:6);
  W = quadcore.euler_rates(eta);
  T = zeros(6);
  T(1:3, 1:3) = quadcore.rotation(eta);
  T(4:6, 4:6) = W';
  through_air = qdot - [v.wind(:); zeros(3, 1)];

  % Inertia (2.20) and its Coriolis torques from the gradient of J = W' I W.
  B = zeros(6);
  B(1:3, 1:3) = v.mass * eye(3);
  B(4:6, 4:6) = W' * v.inertia * W;
  gradient = gradient_of_J(v, eta, W);
  along = zeros(3); across = zeros(3);
  for k = 1:3
    along = along + etadot(k) * gradient(:, :, k);
    across(:, k) = gradient(:, :, k) * etadot;
  end
  coriolis = [zeros(3, 1); 0.5 * (along + across - across') * etadot];

  % Rotors: thrust and reaction (2.40)-(2.42), drag in their discs (2.28)-(2.30), momentum (2.22).
  wrench_F = zeros(6, 1);
  drag_F = zeros(6);
  h_F = zeros(3, 1);
  for i = 1:numel(omega)
    axis_F = v.axes(i, :)';
    lever = [eye(3); skew(v.arms(i, :)')];
    disc = eye(3) - axis_F * axis_F';
    wrench_F = wrench_F + lever * (v.k * omega(i) ^ 2 * axis_F);
    wrench_F(4:6) = wrench_F(4:6) + v.b * sign(omega(i)) * omega(i) ^ 2 * axis_F;
    drag_F = drag_F + (v.K_I + v.K_T + v.K_P) * (lever * disc * lever');
    drag_F = drag_F + flapping(v, omega(i), axis_F, disc, lever);
    h_F = h_F + v.rotor_inertia(i) * omega(i) / v.slow * axis_F;
  end
  gyroscopic = zeros(6);
  gyroscopic(4:6, 4:6) = -skew(h_F);
  parasitic = [v.K_par * norm(through_air(1:3)) * through_air(1:3); zeros(3, 1)];

  rest = T * wrench_F - coriolis + [v.mass * v.gravity(:); zeros(3, 1)] ...
         - T * gyroscopic * T' * qdot - T * drag_F * T' * through_air - parasitic;
  qddot = B \ rest;
end

function gradient = gradient_of_J(v, eta, W)
  s = sin(eta); c = cos(eta);
  gradient = zeros(3, 3, 3);
  gradient(:, :, 1) = [0, 0, 0; 0, -s(1), c(2) * c(1); 0, -c(1), -s(1) * c(2)];
  gradient(:, :, 2) = [0, 0, -c(2); 0, 0, -s(2) * s(1); 0, 0, -c(1) * s(2)];
  for k = 1:3
    half = W' * v.inertia * gradient(:, :, k);
    gradient(:, :, k) = half + half';
  end
end

function drag_F = flapping(v, omega, axis_F, disc, lever)
% (2.25)-(2.27). The thesis omits the sign of the spin in A_1s and B_2.
  s = 1 - 2 * (omega < 0);
  quarter = skew(axis_F);
  A = -(v.A_1c * disc + s * v.A_1s * quarter) / v.r;
  B = -(s * v.B_2 * disc + v.B_1 * quarter);
  drag_F = -v.k * abs(omega) * lever * (A * lever' + [zeros(3), B]);
end

function S = skew(a)
  S = [0, -a(3), a(2); a(3), 0, -a(1); -a(2), a(1), 0];
end
