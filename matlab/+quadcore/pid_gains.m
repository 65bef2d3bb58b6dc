function gains = pid_gains()
% PID_GAINS  Gains of section 6.2 that fly: x, y, z, roll, pitch, yaw. docs/control.md says what ails
% the printed ones.
  gains.kp = [2.4; 2.4; 2.4; 96; 96; 2];
  gains.ki = [0.8; 0.8; 0.8; 96; 96; 0];
  gains.kd = [2.5; 2.5; 11.25; 16; 16; 3];
end
