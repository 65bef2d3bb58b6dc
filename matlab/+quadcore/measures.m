function m = measures(log)
% MEASURES  Return the metrics of `quadcore evaluate` for the log of a closed-loop flight.
%
%   m = quadcore.measures(quadcore.read_log('flight.mat'))
%
% The log must contain the topics reference and error. For the fields, see docs/evaluate.md (m, rad, s).
% A metric that does not apply is NaN, for example the rise time without a step.
  t = log.t(:) - log.t(1);
  wanted = log.topic_reference;
  errors = [log.topic_error.x(:), log.topic_error.y(:), log.topic_error.z(:)];
  away = sqrt(sum(errors .^ 2, 2));
  q = [log.qx(:), log.qy(:), log.qz(:), log.qw(:)];
  rpy = quadcore.roll_pitch_yaw(q);
  yaw = rpy(:, 3) - wanted.yaw(:);
  late = t > t(end) - min(10, t(end) / 2);
  m.rms_position = sqrt(mean(away .^ 2));
  m.max_position = max(away);
  m.final_position = max(away(t > t(end) - 10));
  m.steady_position = norm(mean(errors(late, :), 1));
  m.iae_position = trapz(t, away);
  m.itae_position = trapz(t, away .* t);
  m.max_yaw = max(abs(mod(yaw + pi, 2 * pi) - pi));
  [m.rise_time, m.overshoot, m.settling_time] = measure_step(log, t, wanted, away);
end

function [rise, overshoot, settling] = measure_step(log, t, wanted, away)
  rise = NaN; overshoot = NaN; settling = NaN;
  place = [wanted.x(:), wanted.y(:), wanted.z(:)];
  moved = sqrt(sum(diff(place) .^ 2, 2));
  if numel(moved) < 2
    return
  end
  [jump, at] = max(moved);
  others = moved([1:at - 1, at + 1:end]);
  if jump < 1e-3 || jump < 10 * max(others)
    return
  end
  along = (place(at + 1, :) - place(at, :))' / jump;
  after = at + 1:numel(t);
  time = t(after) - t(at + 1);
  p = [log.x(:), log.y(:), log.z(:)];
  part = (p(after, :) - repmat(place(at, :), numel(after), 1)) * along / jump;
  begun = find(part >= 0.1, 1);
  risen = find(part >= 0.9, 1);
  if ~isempty(risen)
    rise = time(risen) - time(begun);
  end
  overshoot = max(0, max(part) - 1);
  outside = find(away(after) > 0.02 * jump, 1, 'last');
  if isempty(outside)
    settling = 0;
  elseif outside < numel(time)
    settling = time(outside + 1);
  end
end
