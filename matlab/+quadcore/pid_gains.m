function gains = pid_gains()
% PID_GAINS  Return stable gains for the cascade of section 6.2: x, y, z, roll, pitch, yaw.
%
% docs/thesis_gains.md explains why the printed gains are unstable.
  gains.kp = [2.4; 2.4; 2.4; 96; 96; 2];
  gains.ki = [0.8; 0.8; 0.8; 96; 96; 0];
  gains.kd = [2.5; 2.5; 11.25; 16; 16; 3];
end
