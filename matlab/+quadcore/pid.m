function [speeds, memory] = pid(v, gains, period, row, wanted, memory)
% PID  Return the rotor speeds (rad/s) of the cascade of thesis section 6.2.
%
%   gains = quadcore.pid_gains();
%   [speeds, memory] = quadcore.pid(v, gains, client.dt, row, wanted, memory)
%
% v: vehicle, from `quadcore info MODEL --vehicle v.mat`, with the field spins (1 or -1 per rotor).
% gains: from quadcore.pid_gains. row: t, x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz, the first
% columns of a served row. wanted: the reference, a struct with position, velocity, acceleration
% (3 x 1, world axes), yaw and yaw_rate. memory: [] in the first call, then the last result.
  if isempty(memory)
    memory = struct('position', zeros(3, 1), 'angles', zeros(3, 1));
  end
  row = row(:);
  rpy = quadcore.roll_pitch_yaw(row(5:8)')';
  rates_F = row(12:14);

  % (2.43) with an integral: desired acceleration of the frame in the world.
  e = wanted.position - row(2:4);
  memory.position = memory.position + period * e;
  a_W = gains.kp(1:3) .* e + gains.ki(1:3) .* memory.position ...
        + gains.kd(1:3) .* (wanted.velocity - row(9:11)) + wanted.acceleration;
  lift_W = a_W - v.gravity(:);

  % (2.46) to (2.48), with the measured yaw.
  c = cos(rpy(3)); s = sin(rpy(3));
  pitch = atan2(lift_W(1) * c + lift_W(2) * s, lift_W(3));
  roll = asin((lift_W(1) * s - lift_W(2) * c) / norm(lift_W));
  R_WF = quadcore.rotation(rpy);
  thrust = v.mass * (lift_W' * R_WF(:, 3));

  % (2.50): feedback linearisation of the Euler angles.
  W = quadcore.euler_rates(rpy);
  rates = W \ rates_F;
  error = [roll; pitch; wanted.yaw] - rpy;
  error = error - 2 * pi * round(error / (2 * pi));
  memory.angles = memory.angles + period * error;
  y = gains.kp(4:6) .* error + gains.ki(4:6) .* memory.angles ...
      + gains.kd(4:6) .* ([0; 0; wanted.yaw_rate] - rates);
  [~, dW] = quadcore.euler_rates(rpy, rates);
  torque_F = v.inertia * (W * y + dW * rates) + cross(rates_F, v.inertia * rates_F);

  % (2.51): squared rotor speeds for this thrust and torque.
  n = numel(v.spins);
  exerted = zeros(4, n);
  for i = 1:n
    axis_F = v.axes(i, :)';
    force_F = v.k * axis_F;
    exerted(1, i) = force_F(3);
    exerted(2:4, i) = cross(v.arms(i, :)', force_F) + v.spins(i) * v.b * axis_F;
  end
  squares = exerted \ [thrust; torque_F];
  speeds = v.spins(:) .* sqrt(max(0, squares));
end
